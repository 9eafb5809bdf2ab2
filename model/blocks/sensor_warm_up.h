#pragma once
// Models the drift of the sensor zero while the sensor warms up.

#include <cmath>

#include "model/block.h"

namespace softgrip::model {

/// Computes the reading z = y + warm_up (1 - exp(-t/tau)) from the displacement y. t is the time since the
/// start of the measurement campaign, and tau is the time constant of the warm-up.
template <class T>
class SensorWarmUp {
 public:
  static constexpr BlockInfo info = block_info(
      "sensor_warm_up", Station::sensor, Kind::reading, Inverse::ignored, "Sensor warm-up",
      "The zero offset of the sensor drifts while the sensor warms up.", "z = y + warm_up (1 - exp(-t/tau))");
  static constexpr std::array parameters{
      parameter("warm_up_mm", "mm", "total drift of the zero offset during warm-up", Typical{0.2},
                Within{-100.0, 100.0}, Scale{0.1}, Neutral{0.0}),
      parameter("warm_up_time_s", "s", "time constant of the warm-up", Typical{60.0}, Within{0.1, 1e5},
                Scale{30.0})};

  SensorWarmUp(std::span<const T> values, const Preparation&) : warm_up_mm_(values[0]), time_s_(values[1]) {}

  void reset(const T& input) { output_ = input; }
  [[nodiscard]] T output() const { return output_; }

  T sample(const T& displacement_mm, const T&, const Surroundings& surroundings) {
    using std::expm1;
    return output_ = displacement_mm - warm_up_mm_ * expm1(-surroundings.time_s / time_s_);
  }

 private:
  T warm_up_mm_;
  T time_s_;
  T output_{0.0};
};

}  // namespace softgrip::model
