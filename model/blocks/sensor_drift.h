#pragma once
// Models a linear drift of the sensor zero.

#include "model/block.h"

namespace softgrip::model {

/// Computes the reading z = y + rate t from the displacement y. `rate` is the drift rate, and t is the time
/// since the start of the measurement campaign.
template <class T>
class SensorDrift {
 public:
  static constexpr BlockInfo info = block_info(
      "sensor_drift", Station::sensor, Kind::reading, Inverse::ignored, "Sensor drift",
      "The zero offset of the sensor drifts at a constant rate from the start of the measurements.",
      "z = y + rate t");
  static constexpr std::array parameters{parameter("rate_mm_per_h", "mm/h", "constant drift rate",
                                                   Typical{0.5}, Within{-1e5, 1e5}, Scale{1.0},
                                                   Neutral{0.0})};

  SensorDrift(std::span<const T> values, const Preparation&) : rate_mm_per_s_(values[0] / 3600.0) {}

  void reset(const T& input) { output_ = input; }
  [[nodiscard]] T output() const { return output_; }

  T sample(const T& displacement_mm, const T&, const Surroundings& surroundings) {
    return output_ = displacement_mm + rate_mm_per_s_ * surroundings.time_s;
  }

 private:
  T rate_mm_per_s_;
  T output_{0.0};
};

}  // namespace softgrip::model
