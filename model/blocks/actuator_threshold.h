#pragma once
// Models an actuator that does not move below a threshold pressure, for example until the bladder is filled
// or a fold opens.

#include "model/block.h"

namespace softgrip::model {

/// Converts the pressure p to the pressure q above the threshold p0. q = p - p0 for p above p0, q = 0 for p
/// between 0 and p0, and q = p for p below 0.
template <class T>
class ActuatorThreshold {
 public:
  static constexpr BlockInfo info = block_info(
      "actuator_threshold", Station::actuator, Kind::pressure, Inverse::implicit, "Actuator threshold",
      "The actuator moves only at pressures above a threshold.", "q = max(p - threshold, 0) for p >= 0");
  static constexpr std::array parameters{parameter("threshold_kpa", "kPa", "pressure at which motion begins",
                                                   Typical{3.0}, Within{0.0, 1000.0}, Scale{1.0},
                                                   Neutral{0.0})};

  ActuatorThreshold(std::span<const T> values, const Preparation&) : threshold_kpa_(values[0]) {}

  void reset(const T& input) { output_ = map(input); }
  [[nodiscard]] T output() const { return output_; }

  template <class Next>
  void step(const Segment<T>& in, const Surroundings&, Next&& next) {
    const auto pass = [&](const Segment<T>& piece) {
      // The map from the input pressure p to the output pressure q has three zones: above the threshold, q is
      // p minus the threshold. Between 0 and the threshold, q is 0. Below 0, q is p.
      const double middle = 0.5 * (value_of(piece.begin) + value_of(piece.end));
      const T begin = output_;
      output_ = map(piece.end);
      if (middle > value_of(threshold_kpa_)) {
        next(Segment<T>{piece.duration_s, begin, output_, piece.mean - threshold_kpa_});
      } else {
        next(middle >= 0.0 ? Segment<T>{piece.duration_s, begin, output_, output_}
                           : Segment<T>{piece.duration_s, begin, output_, piece.mean});
      }
    };
    if (passes(in, threshold_kpa_)) {
      const T fraction = in.fraction_at(threshold_kpa_);
      cut_at_zero(in.before(fraction), pass);
      cut_at_zero(in.beyond(fraction), pass);
    } else {
      cut_at_zero(in, pass);
    }
  }

  template <class U>
  [[nodiscard]] U peek(const T&, const U& end_kpa, const Surroundings&) const {
    return map(end_kpa);
  }

 private:
  template <class U>
  [[nodiscard]] U map(const U& p) const {
    if (value_of(p) > value_of(threshold_kpa_)) return p - threshold_kpa_;
    return value_of(p) < 0.0 ? p : U(0.0);
  }

  static bool passes(const Segment<T>& in, const T& level) {
    return (value_of(in.begin) - value_of(level)) * (value_of(in.end) - value_of(level)) < 0.0;
  }

  template <class Pass>
  static void cut_at_zero(const Segment<T>& in, Pass&& pass) {
    if (passes(in, T(0.0))) {
      const T fraction = in.fraction_at(T(0.0));
      pass(in.before(fraction));
      pass(in.beyond(fraction));
    } else {
      pass(in);
    }
  }

  T threshold_kpa_;
  T output_{0.0};
};

}  // namespace softgrip::model
