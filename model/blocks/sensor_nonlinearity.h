#pragma once
// Models the nonlinearity of the sensor between its calibration points.

#include "model/block.h"

namespace softgrip::model {

/// Computes the reading z from the displacement y. With x = y/range: z = y + 4 bow x (1 - x) + 6 sqrt(3) wave
/// x (1 - x) (1 - 2x) within the range. Outside the range, the curve continues as straight lines. The
/// difference of reading and displacement is zero at both ends of the range, and `bow` in the middle. The
/// term with `wave` is between 0 and `wave` below the middle of the range, and between -`wave` and 0 above
/// the middle.
template <class T>
class SensorNonlinearity {
 public:
  static constexpr BlockInfo info = block_info(
      "sensor_nonlinearity", Station::sensor, Kind::reading, Inverse::ignored, "Sensor nonlinearity",
      "The scale of the sensor is nonlinear between its two calibration points.",
      "z = y + 4 bow x (1 - x) + 6 sqrt(3) wave x (1 - x) (1 - 2 x), x = y/range");
  static constexpr std::array parameters{
      parameter("bow_mm", "mm", "error of the reading in the middle between the two calibration points",
                Typical{0.2}, Within{-100.0, 100.0}, Scale{0.1}, Neutral{0.0}),
      parameter("wave_mm", "mm",
                "largest error of the reading in each half of the calibrated range; the errors in the two "
                "halves have opposite signs",
                Typical{0.0}, Within{-100.0, 100.0}, Scale{0.1}, Neutral{0.0}),
      parameter("range_mm", "mm",
                "displacement at the upper calibration point; the lower calibration point is at 0",
                Typical{30.0}, Within{0.1, 1000.0}, Scale{10.0})};

  SensorNonlinearity(std::span<const T> values, const Preparation&)
      : bow_mm_(values[0] * 4.0), wave_mm_(values[1] * 10.392304845413264), range_mm_(values[2]) {}

  void reset(const T& input) { output_ = map(input); }
  [[nodiscard]] T output() const { return output_; }

  T sample(const T& displacement_mm, const T&, const Surroundings&) { return output_ = map(displacement_mm); }

 private:
  [[nodiscard]] T map(const T& y) const {
    const T x = y / range_mm_;
    if (value_of(x) < 0.0) return y + (bow_mm_ + wave_mm_) * x;
    if (value_of(x) > 1.0) return y + (wave_mm_ - bow_mm_) * (x - 1.0);
    return y + x * (1.0 - x) * (bow_mm_ + wave_mm_ * (1.0 - 2.0 * x));
  }

  T bow_mm_;   // 4 times the parameter bow
  T wave_mm_;  // 6 sqrt(3) times the parameter wave
  T range_mm_;
  T output_{0.0};
};

}  // namespace softgrip::model
