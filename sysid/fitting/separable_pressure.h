#pragma once
// The pressure at the actuator as a row of stretches, behind delay and lag, with its sensitivity to the lag.

#include <cstdint>
#include <limits>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// A stretch of the pressure at the actuator. `*_by_lag`: derivatives by the lag's time constant.
struct Stretch {
  double end_kpa = 0;
  double mean_kpa = 0;
  double end_by_lag = 0;
  double mean_by_lag = 0;
  double turn_kpa =
      std::numeric_limits<double>::quiet_NaN();  ///< where the pressure turns inside, if it does
  double turn_by_lag = 0;
  double rate_kpa_per_s = 0;   ///< slope at the end
  std::uint32_t duration = 0;  ///< index in PressureWalk::duration_s
  bool ends_sample = false;
};

/// The stretches of a record from its first sample on.
struct PressureWalk {
  double first_kpa = 0;
  std::vector<Stretch> stretches;
  std::vector<double> duration_s;  ///< the different durations that occur
};

/// @param delay_s,lag_s  0: absent.
[[nodiscard]] PressureWalk walk_pressure(const Record& record, double delay_s, double lag_s);

}  // namespace softgrip::sysid
