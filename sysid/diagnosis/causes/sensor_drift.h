#pragma once
// Defines a cause: the zero offset of the sensor drifts. The drift is steady, caused by the warm-up of the
// sensor, sinusoidal, or piecewise linear.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/blocks/sensor_drift.h"
#include "model/blocks/sensor_piecewise_drift.h"
#include "model/blocks/sensor_sinusoidal_drift.h"
#include "model/blocks/sensor_warm_up.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

struct SensorDrift {
  static constexpr std::string_view id = "sensor_drift";
  static constexpr std::array advice{Advice::leave_vented, Advice::record_temperature};
  static constexpr Appears appears = Appears::at_rest;
  static constexpr WhenChanged when_changed{
      "the zero offset of the sensor drifts",
      {"Leave the finger vented for an hour and read the zero every ten minutes.",
       "Check the clamp and the cable of the sensor, and let the sensor warm up before the recording."},
      {{{HealthNumber::zero, Moves::either_way}, {HealthNumber::contact, Moves::either_way}}},
      {SizedBy::Of::largest, "largest drift of the zero", "mm"}};

  /// Form of the cause: the zero offset drifts at a constant rate.
  struct Steady : FormOf<model::SensorDrift> {
    static Starts starts(const Scales& s) {
      const double rate = 3600 * 0.05 * s.span_mm / s.campaign_s;
      return every({{"rate_mm_per_h", {-rate, rate}}});
    }
  };

  /// Form of the cause: the zero offset drifts while the sensor warms up.
  struct WarmUp : FormOf<model::SensorWarmUp> {
    static Starts starts(const Scales& s) {
      return every(
          {{"warm_up_mm", {-0.05 * s.span_mm, 0.05 * s.span_mm}}, {"warm_up_time_s", {0.3 * s.campaign_s}}});
    }
    /// The warm-up time is at least Scales::soonest_s() and at most the duration of the measurement campaign.
    /// A shorter warm-up has the same effect as creep of the actuator. A longer warm-up has the same effect
    /// as a steady drift.
    static Bounds bounds(const Scales& s, const model::Model&) {
      return {{"warm_up_time_s", s.soonest_s(), s.campaign_s}};
    }
  };

  /// Form of the cause: the zero offset follows a slow sinusoid.
  struct Sinusoidal : FormOf<model::SensorSinusoidalDrift> {
    /// Returns start points with six periods, eight phases and two amplitudes.
    static Starts starts(const Scales& s) {
      Starts starts;
      for (const double campaigns : {0.15, 0.25, 0.4, 0.65, 1.0, 1.7}) {
        for (const double size_mm : {0.004 * s.span_mm, 0.016 * s.span_mm}) {
          for (int eighth = 0; eighth < 8; ++eighth) {
            const double angle = eighth * std::numbers::pi / 4;
            starts.push_back(start({{"drift_sin_mm", size_mm * std::cos(angle)},
                                    {"drift_cos_mm", size_mm * std::sin(angle)},
                                    {"drift_period_s", campaigns * s.campaign_s}}));
          }
        }
      }
      return starts;
    }
    /// The period is at least 1/12 of the duration of the measurement campaign and at most 3 times this
    /// duration. With a longer period, the data would contain only a trend.
    static Bounds bounds(const Scales& s, const model::Model&) {
      return {{"drift_period_s", s.campaign_s / 12, 3 * s.campaign_s}};
    }
  };

  /// Form of the cause: the zero offset follows a piecewise linear curve.
  struct Knots : FormOf<model::SensorPiecewiseDrift> {
    static constexpr bool free_form = true;
    static constexpr std::array<Parameter, 0> fitted{};
    static Starts starts(const Scales& s) {
      // smallest knot interval [s]; with a shorter interval, the curve would follow the load cycles
      constexpr double closest_s = 12;
      const auto knots = static_cast<std::size_t>(std::clamp(s.campaign_s / closest_s, 2.0, 16.0));
      Values values = start({{"knot_interval_s", s.campaign_s / static_cast<double>(knots)}});
      values.resize(values.size() + knots, 0.0);
      return {std::move(values)};
    }
  };

  using Forms = List<Steady, WarmUp, Sinusoidal, Knots>;
};

}  // namespace softgrip::sysid::causes
