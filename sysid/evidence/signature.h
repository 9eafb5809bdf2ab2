#pragma once
// Determines at which operating points a cause must have an effect if it is present.

#include <string_view>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Condition on the operating point under which a cause must have an effect.
enum class Appears {
  anywhere,
  at_rest,    ///< at zero pressure while the input is constant; a shifted zero offset must be visible there
              ///< too
  displaced,  ///< at large displacements, because the effect is proportional to the displacement
  held,       ///< at a constant pressure above zero
  /// At fast changes of the input, because the effect is proportional to the rate of the input.
  moving,
};

/// Input of the finger and predicted displacement in one bin.
struct OperatingPoint {
  double pressure_kpa = 0;    ///< pressure that is the input of the finger
  double rate_kpa_per_s = 0;  ///< rate of `pressure_kpa` after a peak detector (see rates_of()), >= 0
  double motion = 0;          ///< displacement that the model predicts, in the unit of the readings
};

/// Returns the rate |dp/dt| of the driving pressure at each sample [kPa/s]. The rate has passed a peak
/// detector that decays with a time constant of 0.5 s.
[[nodiscard]] std::vector<double> rates_of(const Record& record);

/// Returns one value per bin: true if a cause with this condition must have an effect in the bin. A pressure
/// counts as zero if its distance to the end of the pressure range with the smaller magnitude is at most
/// limits::rest_share of the range. For a vacuum actuator, this end is the highest pressure. A rate counts as
/// zero if it is at most limits::rest_share of the highest rate, and as fast if it exceeds half the highest
/// rate. A displacement counts as large in one half of its range. This is the upper half, unless the mean
/// displacement at zero pressure is in the upper half. Then it is the lower half.
[[nodiscard]] std::vector<bool> required_at(Appears appears, const std::vector<OperatingPoint>& conditions);

/// Returns true if a condition is met often enough for a decision (limits::fewest_occurrences).
/// @param required  result of required_at() for the condition.
[[nodiscard]] bool is_met(const std::vector<bool>& required);

/// Returns advice for the user if the data do not meet the condition `appears`. The advice describes a
/// recording that meets the condition.
[[nodiscard]] std::string_view recording_for(Appears appears);

}  // namespace softgrip::sysid
