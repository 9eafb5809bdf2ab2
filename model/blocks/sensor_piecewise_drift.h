#pragma once
// Models a piecewise linear drift of the sensor zero.

#include <cstddef>
#include <vector>

#include "model/block.h"

namespace softgrip::model {

/// Adds a drift to the displacement. The drift consists of straight lines between knots, one knot per
/// interval after the start of the measurement campaign. The drift is zero at the start and constant after
/// the last knot.
template <class T>
class SensorPiecewiseDrift {
 public:
  static constexpr BlockInfo info = block_info(
      "sensor_piecewise_drift", Station::sensor, Kind::reading, Inverse::ignored,
      "Piecewise linear sensor drift",
      "The zero offset of the sensor is a piecewise linear function of time, with knots at equal intervals.",
      "z = y + straight lines through knot1, knot2 ... every interval", Formerly{"sensor_free_drift"});
  static constexpr std::array parameters{parameter("knot_interval_s", "s", "time between two knots",
                                                   Typical{30.0}, Within{0.1, 1e5}, Scale{10.0},
                                                   IfLeftOut{30.0})};
  static constexpr std::array repeated{
      parameter("knot#_mm", "mm", "drift of the zero offset # intervals after the start", Typical{0.1},
                Within{-100.0, 100.0}, Scale{0.1}, Neutral{0.0})};
  static constexpr std::size_t max_parts = 16;

  SensorPiecewiseDrift(std::span<const T> values, const Preparation&)
      : knots_per_s_(1.0 / values[0]), knots_mm_(values.begin() + parameters.size(), values.end()) {}

  void reset(const T& input) { output_ = input; }
  [[nodiscard]] T output() const { return output_; }

  T sample(const T& displacement_mm, const T&, const Surroundings& surroundings) {
    return output_ = displacement_mm + between_knots(surroundings.time_s);
  }

 private:
  [[nodiscard]] T between_knots(double time_s) const {
    const T intervals = time_s * knots_per_s_;
    const double past = value_of(intervals);
    if (!(past < static_cast<double>(knots_mm_.size()))) return knots_mm_.back();
    const std::size_t next = past > 0.0 ? static_cast<std::size_t>(past) : 0;
    const T last_mm = next == 0 ? T(0.0) : knots_mm_[next - 1];
    return last_mm + (knots_mm_[next] - last_mm) * (intervals - static_cast<double>(next));
  }

  T knots_per_s_;
  std::vector<T> knots_mm_;
  T output_{0.0};
};

}  // namespace softgrip::model
