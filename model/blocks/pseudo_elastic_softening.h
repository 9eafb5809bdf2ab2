#pragma once
// Models a material that is softer at pressures below the largest pressure that it has had so far (Mullins
// effect).

#include <algorithm>
#include <cmath>

#include "model/block.h"
#include "model/clip.h"

namespace softgrip::model {

/// Implements pseudo-elasticity (Ogden and Roxburgh, Proc. R. Soc. A 455, 1999; with the hyperbolic tangent
/// of Dorfmann and Ogden, Int. J. Solids Struct. 41, 2004). The driving pressure q, which is the output of
/// the block, takes the place of the stored energy. While the pressure p is the largest so far, q = p.
/// Otherwise p = q/(1 + s m tanh((m - q)/range)), where m is the largest pressure so far; s and `range` are
/// parameters. After the first loading, unloading and reloading follow one curve, which meets the curve of
/// the first loading at m. q rises with p for all parameter values. The block stores m over the whole
/// measurement campaign: rest() keeps m, and only reset() clears m.
template <class T>
class PseudoElasticSoftening {
 public:
  static constexpr BlockInfo info = block_info(
      "pseudo_elastic_softening", Station::actuator, Kind::pressure, Inverse::implicit,
      "Pseudo-elastic softening",
      "The finger becomes softer as the pressure falls below the largest previous pressure (Mullins effect).",
      "q = p (1 + softening m tanh((m - q)/range)), m = largest pressure so far");
  static constexpr std::array parameters{
      parameter("softening_per_kpa", "1/kPa",
                "relative increase of the gain per kPa of the largest previous pressure", Typical{0.002},
                Within{0.0, 1.0}, Scale{0.001}, Neutral{0.0}),
      parameter("range_kpa", "kPa",
                "distance below the largest previous pressure over which the softening develops",
                Typical{15.0}, Within{0.01, 10000.0}, Scale{5.0})};

  PseudoElasticSoftening(std::span<const T> values, const Preparation&)
      : softening_per_kpa_(values[0]), range_kpa_(values[1]) {}

  void reset(const T& input) {
    largest_kpa_ = greater(input, T(0.0));
    output_ = map(input);
  }
  void rest(const T& input) {
    largest_kpa_ = greater(input, largest_kpa_);
    output_ = map(input);
  }
  [[nodiscard]] T output() const { return output_; }
  [[nodiscard]] const T& largest_kpa() const { return largest_kpa_; }

  template <class Next>
  void step(const Segment<T>& in, const Surroundings&, Next&& next) {
    const double largest = value_of(largest_kpa_);
    if (value_of(in.end) <= largest) {
      below(in, next);
    } else if (value_of(in.begin) >= largest) {
      beyond(in, next);
    } else {
      const T fraction = in.fraction_at(largest_kpa_);
      below(in.before(fraction), next);
      beyond(in.beyond(fraction), next);
    }
  }

  template <class U>
  [[nodiscard]] U peek(const T&, const U& end_kpa, const Surroundings&) const {
    return map(end_kpa);
  }

 private:
  /// Returns the driving pressure q at the pressure `p` for a constant largest pressure m. The last Newton
  /// step uses the type U, so that the result has derivatives.
  template <class U>
  [[nodiscard]] U map(const U& p) const {
    const double pressure = value_of(p), largest = value_of(largest_kpa_);
    if (pressure >= largest) return p;
    const double from = pressure > 0 ? solved(pressure, largest) : 0;
    const U share =
        softening_per_kpa_ * largest_kpa_ * hyperbolic_tangent(U((largest_kpa_ - from) / range_kpa_));
    if (pressure <= 0) return p * (1.0 + share);
    return from + (p * (1.0 + share) - from) * (1.0 / slope(from, pressure, largest));
  }

  /// Returns the driving pressure q by Newton's method in the interval from the pressure p to the largest
  /// pressure m, which contains q. The iteration starts at the present output. If a step leaves the interval,
  /// bisection replaces the step. The result is accurate to half of the digits of a double. The last Newton
  /// step in map() makes the remaining digits accurate.
  [[nodiscard]] double solved(double pressure, double largest) const {
    double low = pressure, high = largest, q = std::clamp(value_of(output_), low, high);
    const double strength = value_of(softening_per_kpa_) * largest, range = value_of(range_kpa_);
    constexpr int most_rounds = 60;
    for (int round = 0; round < most_rounds; ++round) {
      const double over = q - pressure * (1 + strength * hyperbolic_tangent((largest - q) / range));
      (over > 0 ? high : low) = q;
      double next = q - over / slope(q, pressure, largest);
      if (!(next >= low && next <= high)) next = 0.5 * (low + high);
      if (std::abs(next - q) <= 1e-8 * std::min(largest, range)) return next;
      q = next;
    }
    return q;
  }

  /// Returns the derivative of q - p (1 + s m tanh((m - q)/range)) with respect to q. The derivative is at
  /// least 1 for p >= 0.
  [[nodiscard]] double slope(double q, double pressure, double largest) const {
    const double range = value_of(range_kpa_), t = hyperbolic_tangent((largest - q) / range);
    return 1 + pressure * value_of(softening_per_kpa_) * largest * (1 - t * t) / range;
  }

  /// Returns tanh(x). x must be >= 0.
  template <class U>
  [[nodiscard]] static U hyperbolic_tangent(const U& x) {
    using std::expm1;
    const U e = expm1(U(x * -2.0));
    return -e / (2.0 + e);
  }

  // Computes the mean of the added pressure by Simpson's rule, for a pressure that changes linearly over the
  // segment.
  template <class Next>
  void below(const Segment<T>& in, Next&& next) {
    const T begin = output_, halfway = (in.begin + in.end) * 0.5;
    output_ = map(in.end);
    const T added = (begin - in.begin) + (map(halfway) - halfway) * 4.0 + (output_ - in.end);
    next(Segment<T>{in.duration_s, begin, output_, in.mean + added * (1.0 / 6.0)});
  }

  template <class Next>
  void beyond(const Segment<T>& in, Next&& next) {
    largest_kpa_ = in.end;
    output_ = in.end;
    next(in);
  }

  T softening_per_kpa_;
  T range_kpa_;
  T largest_kpa_{0.0};
  T output_{0.0};
};

}  // namespace softgrip::model
