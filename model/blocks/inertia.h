#pragma once
// Models the oscillation of a spring-mass system: the mass of finger and load, and the stiffness of the
// actuator.

#include <numbers>

#include "model/block.h"
#include "model/second_order.h"

namespace softgrip::model {

/// Solves z'' + 2 d w z' + w^2 z = w^2 y with w = 2 pi / period, where y is the input and z the output. The
/// solution is exact if y is a parabola over each segment. d is the damping ratio. With period 0, the block
/// passes y on unchanged.
template <class T>
class Inertia {
 public:
  static constexpr BlockInfo info =
      block_info("inertia", Station::load, Kind::displacement, Inverse::ignored, "Inertia",
                 "Oscillation of a mass and a spring, as a second-order mode.",
                 "z'' + 2 d w z' + w^2 z = w^2 y, w = 2 pi/period");
  static constexpr std::array parameters{
      parameter("period_s", "s", "period of the undamped mode", Typical{0.1}, Within{0.0, 1e4}, Scale{0.05},
                Neutral{0.0}, Latency{}),
      parameter("damping_ratio", "", "damping ratio d; a mode with d of 1 or more does not oscillate",
                Typical{0.2}, Within{0.005, 0.95}, Scale{0.1})};

  Inertia(std::span<const T> values, const Preparation&)
      : passes_(!(value_of(values[0]) > 1e-6)),
        mode_(passes_ ? T(1.0) : T(2.0 * std::numbers::pi / values[0]), values[1]) {}

  void reset(const T& input) { mode_.reset(input); }
  [[nodiscard]] T output() const { return mode_.value(); }

  template <class Next>
  void step(const Segment<T>& in, const Surroundings&, Next&& next) {
    if (passes_) {
      mode_.reset(in.end);
      next(in);
      return;
    }
    if (!(value_of(in.duration_s) > 0.0)) return;  // a jump of the input does not move the mass
    const T begin = mode_.value();
    const T mean = mode_.advance(in);
    next(Segment<T>{in.duration_s, begin, mode_.value(), mean});
  }

 private:
  bool passes_;
  SecondOrder<T> mode_;
};

}  // namespace softgrip::model
