#pragma once
// Computes the pressure at the actuator, behind delay and lag, as a sequence of segments. Also computes the
// sensitivity of this pressure to the time constant of the lag.

#include <cstdint>
#include <limits>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// A segment of the pressure curve at the actuator. Members with `_by_lag` are derivatives with respect to
/// the time constant of the lag.
struct Stretch {
  double end_kpa = 0;
  double mean_kpa = 0;
  double end_by_lag = 0;
  double mean_by_lag = 0;
  /// Pressure at a reversal within the segment; NaN: the segment contains no reversal.
  double turn_kpa = std::numeric_limits<double>::quiet_NaN();
  double turn_by_lag = 0;
  double rate_kpa_per_s = 0;   ///< slope of the pressure at the end of the segment
  std::uint32_t duration = 0;  ///< index of the segment's duration in PressureWalk::duration_s
  bool ends_sample = false;    ///< true: the segment ends at a sample
};

/// The segments of the pressure in a record. The first segment begins at the first sample.
struct PressureWalk {
  double first_kpa = 0;
  std::vector<Stretch> stretches;
  std::vector<double> duration_s;  ///< list of all different durations of segments
};

/// Computes the pressure at the actuator.
/// @param delay_s,lag_s  delay and time constant of the lag; 0: absent.
[[nodiscard]] PressureWalk walk_pressure(const Record& record, double delay_s, double lag_s);

}  // namespace softgrip::sysid
