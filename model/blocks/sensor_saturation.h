#pragma once
// Models readings that saturate at the ends of the measuring range.

#include "model/block.h"
#include "model/clip.h"

namespace softgrip::model {

/// Computes the reading z from the displacement y. z = y within the measuring range. If y is outside the
/// range, z is the nearer end of the range.
template <class T>
class SensorSaturation {
 public:
  static constexpr BlockInfo info = block_info(
      "sensor_saturation", Station::sensor, Kind::reading, Inverse::ignored, "Sensor saturation",
      "The reading saturates at the ends of the measuring range.", "z = min(max(y, lower), upper)");
  static constexpr std::array parameters{parameter("lower_mm", "mm", "smallest reading", Typical{-10.0},
                                                   Within{-10000.0, 10000.0}, Scale{2.0}, Neutral{-10000.0}),
                                         parameter("upper_mm", "mm", "largest reading", Typical{20.0},
                                                   Within{-10000.0, 10000.0}, Scale{2.0}, Neutral{10000.0})};

  SensorSaturation(std::span<const T> values, const Preparation&)
      : lower_mm_(values[0]), upper_mm_(values[1]) {}

  static std::string_view objection(std::span<const double> values) {
    return values[0] < values[1] ? std::string_view{} : "lower_mm must be below upper_mm";
  }

  void reset(const T& input) { output_ = clipped(input); }
  [[nodiscard]] T output() const { return output_; }

  T sample(const T& displacement_mm, const T&, const Surroundings&) {
    return output_ = clipped(displacement_mm);
  }

 private:
  [[nodiscard]] T clipped(const T& y) const { return lesser(greater(y, lower_mm_), upper_mm_); }

  T lower_mm_;
  T upper_mm_;
  T output_{0.0};
};

}  // namespace softgrip::model
