#pragma once
// The zero of the sensor wanders: steadily, or while it warms up.

#include <cmath>

#include "model/block.h"

namespace softgrip::model {

/// z = y + rate t + warm_up (1 - exp(-t/tau)), t the time of the campaign.
template <class T>
class SensorDrift {
 public:
  static constexpr BlockInfo info{.id = "sensor_drift",
                                  .station = Station::sensor,
                                  .kind = Kind::reading,
                                  .inverse = Inverse::ignored,
                                  .title = "Sensor drift",
                                  .meaning = "The zero wanders with the time of the campaign.",
                                  .equation = "z = y + rate t + warm_up (1 - exp(-t/tau))"};
  static constexpr std::array parameters{ParameterSpec{.name = "rate_mm_per_h",
                                                       .unit = "mm/h",
                                                       .default_value = 0.5,
                                                       .lower = -1e5,
                                                       .upper = 1e5,
                                                       .scale = 1.0,
                                                       .meaning = "steady drift",
                                                       .neutral = 0.0},
                                         ParameterSpec{.name = "warm_up_mm",
                                                       .unit = "mm",
                                                       .default_value = 0.2,
                                                       .lower = -100.0,
                                                       .upper = 100.0,
                                                       .scale = 0.1,
                                                       .meaning = "drift in the course of warming up",
                                                       .neutral = 0.0},
                                         ParameterSpec{.name = "warm_up_time_s",
                                                       .unit = "s",
                                                       .default_value = 60.0,
                                                       .lower = 0.1,
                                                       .upper = 1e5,
                                                       .scale = 30.0,
                                                       .meaning = "time constant of warming up"}};

  SensorDrift(std::span<const T> values, const Preparation&)
      : rate_mm_per_s_(values[0] / 3600.0), warm_up_mm_(values[1]), warm_up_time_s_(values[2]) {}

  void reset(const T& input) { output_ = input; }
  [[nodiscard]] T output() const { return output_; }

  T sample(const T& displacement_mm, const T&, const Surroundings& surroundings) {
    using std::expm1;
    const double t = surroundings.time_s;
    return output_ = displacement_mm + rate_mm_per_s_ * t - warm_up_mm_ * expm1(-t / warm_up_time_s_);
  }

 private:
  T rate_mm_per_s_;
  T warm_up_mm_;
  T warm_up_time_s_;
  T output_{0.0};
};

}  // namespace softgrip::model
