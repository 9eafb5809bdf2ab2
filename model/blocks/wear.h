#pragma once
// Models a gain of the actuator that drifts with use.

#include "model/block.h"
#include "model/moving_gain.h"

namespace softgrip::model {

/// Multiplies the displacement y by 1 + c l. positive_gain() limits this factor to positive values. c is the
/// change of the gain per travel, and l is the total travel of the actuator in both directions during the
/// measurement campaign. The block stores l over the whole campaign: rest() keeps l, and only reset() clears
/// l.
template <class T>
class Wear {
 public:
  static constexpr BlockInfo info =
      block_info("wear", Station::actuator, Kind::displacement, Inverse::implicit, "Wear",
                 "The gain of the finger changes with the total travel of the finger.",
                 "z = y (1 + gain l), l = travel so far; kept positive");
  static constexpr std::array parameters{
      parameter("gain_per_m", "1/m", "relative change of the gain per metre of travel", Typical{0.05},
                Within{-1000.0, 1000.0}, Scale{0.05}, Neutral{0.0})};

  Wear(std::span<const T> values, const Preparation&) : gain_per_m_(values[0]) {}

  void reset(const T& input) {
    way_mm_ = T(0.0);
    rest(input);
  }
  void rest(const T& input) {
    gain_.reset(at(way_mm_));
    input_mm_ = input;
    output_ = input;
  }
  [[nodiscard]] T output() const { return output_; }

  template <class Next>
  void step(const Segment<T>& in, const Surroundings&, Next&& next) {
    way_mm_ = way_to(in.end);
    input_mm_ = in.end;
    const Segment<T> out = gain_.step(in, at(way_mm_));
    output_ = out.end;
    next(out);
  }

  template <class U>
  [[nodiscard]] U peek(const T&, const U& end_mm, const Surroundings&) const {
    return end_mm * at(way_to(end_mm));
  }

 private:
  template <class U>
  [[nodiscard]] U way_to(const U& end_mm) const {
    const U change = end_mm - input_mm_;
    return way_mm_ + (value_of(change) < 0.0 ? U(-change) : change);
  }

  template <class U>
  [[nodiscard]] U at(const U& way_mm) const {
    return positive_gain(U(gain_per_m_ * way_mm * 1e-3));
  }

  T gain_per_m_;
  T way_mm_{0.0};  // total travel l of the actuator [mm]
  T input_mm_{0.0};
  MovingGain<T> gain_;
  T output_{0.0};
};

}  // namespace softgrip::model
