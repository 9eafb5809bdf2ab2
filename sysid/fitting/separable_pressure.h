#pragma once
// The pressure at the actuator after delay and lag as a sequence of stretches, with its sensitivity to the
// lag.

#include <cstdint>
#include <limits>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// A stretch of the pressure at the actuator. `*_by_lag` are derivatives with respect to the lag's time
/// constant.
struct Stretch {
  double end_kpa = 0;
  double mean_kpa = 0;
  double end_by_lag = 0;
  double mean_by_lag = 0;
  double turn_kpa =
      std::numeric_limits<double>::quiet_NaN();  ///< pressure at a reversal within the stretch; NaN: none
  double turn_by_lag = 0;
  double rate_kpa_per_s = 0;   ///< slope at the end
  std::uint32_t duration = 0;  ///< index in PressureWalk::duration_s
  bool ends_sample = false;
};

/// The stretches of a record, beginning at its first sample.
struct PressureWalk {
  double first_kpa = 0;
  std::vector<Stretch> stretches;
  std::vector<double> duration_s;  ///< the distinct durations
};

/// Computes the pressure at the actuator. @param delay_s,lag_s  0: absent.
[[nodiscard]] PressureWalk walk_pressure(const Record& record, double delay_s, double lag_s);

}  // namespace softgrip::sysid
