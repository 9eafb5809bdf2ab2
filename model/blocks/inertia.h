#pragma once
// Models the oscillation of a spring-mass system: the mass of finger and load, and the stiffness of the
// actuator.

#include <cmath>
#include <numbers>

#include "model/block.h"

namespace softgrip::model {

/// Solves z'' + 2 d w z' + w^2 z = w^2 y with w = 2 pi / period, where y is the input and z the output. The
/// solution is exact if y is a parabola over each segment. d is the damping ratio. With period 0, the block
/// passes y on unchanged.
template <class T>
class Inertia {
 public:
  static constexpr BlockInfo info =
      block_info("inertia", Station::load, Kind::displacement, Inverse::ignored, "Inertia",
                 "Oscillation: a second-order mode of mass and spring.",
                 "z'' + 2 d w z' + w^2 z = w^2 y, w = 2 pi/period");
  static constexpr std::array parameters{
      parameter("period_s", "s", "period of the undamped mode", Typical{0.1}, Within{0.0, 1e4}, Scale{0.05},
                Neutral{0.0}, Latency{}),
      parameter("damping_ratio", "", "damping ratio d; a mode with d of 1 or more does not oscillate",
                Typical{0.2}, Within{0.005, 0.95}, Scale{0.1})};

  Inertia(std::span<const T> values, const Preparation&)
      : passes_(!(value_of(values[0]) > 1e-6)),
        omega_(passes_ ? T(1.0) : T(2.0 * std::numbers::pi / values[0])),
        damping_(values[1]) {}

  void reset(const T& input) {
    output_ = input;
    speed_ = T(0.0);
  }
  [[nodiscard]] T output() const { return output_; }

  template <class Next>
  void step(const Segment<T>& in, const Surroundings&, Next&& next) {
    if (passes_) {
      output_ = in.end;
      next(in);
      return;
    }
    if (!(value_of(in.duration_s) > 0.0)) return;  // a jump of the input does not move the mass
    const T begin = output_;
    const T speed = speed_;
    advance(in);
    // The mean of the output z follows from the integral of the differential equation over the segment.
    const T left = (speed_ - speed) + 2.0 * damping_ * omega_ * (output_ - begin);
    next(Segment<T>{in.duration_s, begin, output_, in.mean - left / (omega_ * omega_ * in.duration_s)});
  }

 private:
  // Computes the solution as the sum of a parabola a + b t + c t^2 (particular solution) and a decaying
  // homogeneous solution.
  void advance(const Segment<T>& in) {
    using std::cos;
    using std::exp;
    using std::sin;
    using std::sqrt;
    const T& dt = in.duration_s;
    const T bend = value_of(omega_) * value_of(dt) < 1e-6
                       ? T(0.0)
                       : in.bend();  // in short segments, the computed curvature is only rounding error
    const T c = -bend / (dt * dt);
    const T b = (in.end - in.begin + bend) / dt - 4.0 * damping_ * c / omega_;
    const T a = in.begin - 2.0 * damping_ * b / omega_ - 2.0 * c / (omega_ * omega_);
    const T decay = damping_ * omega_;
    const T ringing = omega_ * sqrt(1.0 - damping_ * damping_);
    const T envelope = exp(-decay * dt);
    const T cosine = envelope * cos(ringing * dt);
    const T sine = envelope * sin(ringing * dt) / ringing;
    const T offset = output_ - a;
    const T rate = speed_ - b;
    output_ = a + b * dt + c * dt * dt + (cosine + decay * sine) * offset + sine * rate;
    speed_ = b + 2.0 * c * dt - omega_ * omega_ * sine * offset + (cosine - decay * sine) * rate;
  }

  bool passes_;
  T omega_;
  T damping_;
  T output_{0.0};
  T speed_{0.0};
};

}  // namespace softgrip::model
