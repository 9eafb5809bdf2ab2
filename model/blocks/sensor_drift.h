#pragma once
// The zero of the sensor wanders: steadily, while it warms up, to and fro, or as it likes.

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "model/block.h"

namespace softgrip::model {

/// z = y + rate t + warm_up (1 - exp(-t/tau)) + a sin(w t) + b (cos(w t) - 1), w = 2 pi / period, t the time
/// of the campaign: nothing at its start. The wander is slow, as the temperature of a room; an oscillation is
/// PeriodicDisturbance. To this come straight lines between knots, one every interval after the start, for a
/// zero that keeps to no law; beyond the last knot it stays.
template <class T>
class SensorDrift {
 public:
  static constexpr BlockInfo info{.id = "sensor_drift",
                                  .station = Station::sensor,
                                  .kind = Kind::reading,
                                  .inverse = Inverse::ignored,
                                  .title = "Sensor drift",
                                  .meaning = "The zero wanders with the time of the campaign.",
                                  .equation =
                                      "z = y + rate t + warm_up (1 - exp(-t/tau)) + "
                                      "a sin(2 pi t/period) + b (cos(2 pi t/period) - 1) + "
                                      "straight lines through knot1, knot2 ... every interval"};
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
                                                       .meaning = "time constant of warming up"},
                                         ParameterSpec{.name = "wander_sin_mm",
                                                       .unit = "mm",
                                                       .default_value = 0.1,
                                                       .lower = -100.0,
                                                       .upper = 100.0,
                                                       .scale = 0.1,
                                                       .meaning = "a, of the wander",
                                                       .neutral = 0.0,
                                                       .if_left_out = 0.0},
                                         ParameterSpec{.name = "wander_cos_mm",
                                                       .unit = "mm",
                                                       .default_value = 0.1,
                                                       .lower = -100.0,
                                                       .upper = 100.0,
                                                       .scale = 0.1,
                                                       .meaning = "b, of the wander",
                                                       .neutral = 0.0,
                                                       .if_left_out = 0.0},
                                         ParameterSpec{.name = "wander_period_s",
                                                       .unit = "s",
                                                       .default_value = 300.0,
                                                       .lower = 1.0,
                                                       .upper = 1e5,
                                                       .scale = 30.0,
                                                       .meaning = "period of the wander",
                                                       .if_left_out = 300.0},
                                         ParameterSpec{.name = "knot_interval_s",
                                                       .unit = "s",
                                                       .default_value = 30.0,
                                                       .lower = 0.1,
                                                       .upper = 1e5,
                                                       .scale = 10.0,
                                                       .meaning = "time between knots",
                                                       .if_left_out = 30.0}};
  static constexpr std::array repeated{ParameterSpec{.name = "knot#_mm",
                                                     .unit = "mm",
                                                     .default_value = 0.1,
                                                     .lower = -100.0,
                                                     .upper = 100.0,
                                                     .scale = 0.1,
                                                     .meaning = "of the zero, # intervals after the start",
                                                     .neutral = 0.0}};
  static constexpr std::size_t min_parts = 0;
  static constexpr std::size_t max_parts = 16;

  SensorDrift(std::span<const T> values, const Preparation&)
      : rate_mm_per_s_(values[0] / 3600.0),
        warm_up_mm_(values[1]),
        warm_up_time_s_(values[2]),
        sin_mm_(values[3]),
        cos_mm_(values[4]),
        period_s_(values[5]),
        knots_per_s_(1.0 / values[6]),
        knots_mm_(values.begin() + parameters.size(), values.end()) {}

  void reset(const T& input) { output_ = input; }
  [[nodiscard]] T output() const { return output_; }

  T sample(const T& displacement_mm, const T&, const Surroundings& surroundings) {
    using std::cos;
    using std::expm1;
    using std::sin;
    const double t = surroundings.time_s;
    output_ = displacement_mm + rate_mm_per_s_ * t - warm_up_mm_ * expm1(-t / warm_up_time_s_);
    if (!knots_mm_.empty()) output_ = output_ + between_knots(t);
    if (is_zero(sin_mm_) && is_zero(cos_mm_)) return output_;
    const T turn = (2.0 * std::numbers::pi * t) / period_s_;
    return output_ = output_ + sin_mm_ * sin(turn) + cos_mm_ * (cos(turn) - 1.0);
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

  T rate_mm_per_s_;
  T warm_up_mm_;
  T warm_up_time_s_;
  T sin_mm_;
  T cos_mm_;
  T period_s_;
  T knots_per_s_;
  std::vector<T> knots_mm_;
  T output_{0.0};
};

}  // namespace softgrip::model
