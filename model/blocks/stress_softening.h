#pragma once
// Models a material that becomes softer each time its load exceeds all earlier loads (Mullins effect of
// filled rubbers).

#include "model/block.h"
#include "model/clip.h"

namespace softgrip::model {

/// Computes the driving pressure q = p (1 + s m/(1 + b m)), where m is the largest pressure so far; s and b
/// are parameters. The curve of q over p is convex on the first loading. After the first loading, the curve
/// is straight up to m and lies above the curve of the first loading. The parameter b makes the softening
/// saturate. The block stores m over the whole measurement campaign: rest() keeps m, and only reset() clears
/// m.
template <class T>
class StressSoftening {
 public:
  static constexpr BlockInfo info = block_info(
      "stress_softening", Station::actuator, Kind::pressure, Inverse::implicit, "Stress softening",
      "The finger becomes permanently softer when the pressure exceeds its largest previous value (Mullins "
      "effect).",
      "q = p (1 + softening m/(1 + saturation m)), m = largest pressure so far");
  static constexpr std::array parameters{
      parameter("softening_per_kpa", "1/kPa",
                "relative increase of the gain per kPa of the largest previous pressure", Typical{0.002},
                Within{0.0, 1.0}, Scale{0.001}, Neutral{0.0}),
      parameter("saturation_per_kpa", "1/kPa",
                "saturation of the softening: with a value above 0, the softening approaches a limit at high "
                "pressures",
                Typical{0.02}, Within{0.0, 10.0}, Scale{0.01}, Neutral{0.0}, IfLeftOut{0.0},
                Formerly{"levelling_per_kpa"})};

  StressSoftening(std::span<const T> values, const Preparation&)
      : softening_per_kpa_(values[0]), saturation_per_kpa_(values[1]) {}

  void reset(const T& input) {
    largest_kpa_ = greater(input, T(0.0));
    output_ = map(input, largest_kpa_);
  }
  void rest(const T& input) {
    largest_kpa_ = greater(input, largest_kpa_);
    output_ = map(input, largest_kpa_);
  }
  [[nodiscard]] T output() const { return output_; }
  [[nodiscard]] const T& largest_kpa() const { return largest_kpa_; }

  template <class Next>
  void step(const Segment<T>& in, const Surroundings&, Next&& next) {
    const double largest = value_of(largest_kpa_);
    if (value_of(in.end) <= largest) {
      again(in, next);
    } else if (value_of(in.begin) >= largest) {
      anew(in, next);
    } else {
      const T fraction = in.fraction_at(largest_kpa_);
      again(in.before(fraction), next);
      anew(in.beyond(fraction), next);
    }
  }

  template <class U>
  [[nodiscard]] U peek(const T&, const U& end_kpa, const Surroundings&) const {
    return value_of(end_kpa) > value_of(largest_kpa_) ? map(end_kpa, end_kpa) : map(end_kpa, U(largest_kpa_));
  }

 private:
  template <class U>
  [[nodiscard]] U map(const U& p, const U& largest) const {
    return p * (1.0 + softening_per_kpa_ * largest / (1.0 + saturation_per_kpa_ * largest));
  }

  // Passes on a segment whose pressures are all below m, the largest pressure so far. Below m, the map from p
  // to q is a straight line.
  template <class Next>
  void again(const Segment<T>& in, Next&& next) {
    const T begin = output_;
    output_ = map(in.end, largest_kpa_);
    next(Segment<T>{in.duration_s, begin, output_, map(in.mean, largest_kpa_)});
  }

  // Passes on a segment whose pressures are all above the previous largest pressure, so that m equals the
  // present pressure. Simpson's rule gives the mean of the added pressure, for a pressure that changes
  // linearly. The mean is exact if b is zero.
  template <class Next>
  void anew(const Segment<T>& in, Next&& next) {
    const T begin = output_;
    largest_kpa_ = in.end;
    output_ = map(in.end, in.end);
    const T middle = (in.begin + in.end) * 0.5;
    const T mean = (added(in.begin) + added(middle) * 4.0 + added(in.end)) * (1.0 / 6.0);
    next(Segment<T>{in.duration_s, begin, output_, in.mean + mean});
  }

  [[nodiscard]] T added(const T& p) const { return map(p, p) - p; }

  T softening_per_kpa_;
  T saturation_per_kpa_;
  T largest_kpa_{0.0};
  T output_{0.0};
};

}  // namespace softgrip::model
