#pragma once
// Models a slow sinusoidal drift of the sensor zero.

#include <cmath>
#include <numbers>

#include "model/block.h"

namespace softgrip::model {

/// Computes the reading z = y + a sin(w t) + b (cos(w t) - 1) from the displacement y, with the parameters a,
/// b and w = 2 pi / period. t is the time since the start of the measurement campaign. The block models a
/// slow drift, for example with the room temperature. PeriodicDisturbance models faster oscillations.
template <class T>
class SensorSinusoidalDrift {
 public:
  static constexpr BlockInfo info =
      block_info("sensor_sinusoidal_drift", Station::sensor, Kind::reading, Inverse::ignored,
                 "Sinusoidal sensor drift", "The zero offset of the sensor drifts slowly and sinusoidally.",
                 "z = y + a sin(2 pi t/period) + b (cos(2 pi t/period) - 1)", Formerly{"sensor_wander"});
  static constexpr std::array parameters{
      parameter("drift_sin_mm", "mm", "amplitude a of the sine component of the drift", Typical{0.1},
                Within{-100.0, 100.0}, Scale{0.1}, Neutral{0.0}, IfLeftOut{0.0}, Formerly{"wander_sin_mm"}),
      parameter("drift_cos_mm", "mm", "amplitude b of the cosine component of the drift", Typical{0.1},
                Within{-100.0, 100.0}, Scale{0.1}, Neutral{0.0}, IfLeftOut{0.0}, Formerly{"wander_cos_mm"}),
      parameter("drift_period_s", "s", "period of the sinusoidal drift", Typical{300.0}, Within{1.0, 1e5},
                Scale{30.0}, IfLeftOut{300.0}, Formerly{"wander_period_s"})};

  SensorSinusoidalDrift(std::span<const T> values, const Preparation&)
      : sin_mm_(values[0]), cos_mm_(values[1]), period_s_(values[2]) {}

  void reset(const T& input) { output_ = input; }
  [[nodiscard]] T output() const { return output_; }

  T sample(const T& displacement_mm, const T&, const Surroundings& surroundings) {
    using std::cos;
    using std::sin;
    const T turn = (2.0 * std::numbers::pi * surroundings.time_s) / period_s_;
    return output_ = displacement_mm + sin_mm_ * sin(turn) + cos_mm_ * (cos(turn) - 1.0);
  }

 private:
  T sin_mm_;
  T cos_mm_;
  T period_s_;
  T output_{0.0};
};

}  // namespace softgrip::model
