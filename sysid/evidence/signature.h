#pragma once
// Finds the bins in which a cause must have an effect.

#include <cstddef>
#include <string_view>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Operating points at which a cause must have an effect.
enum class Appears {
  anywhere,
  at_rest,    ///< all pressures, including zero, because a shifted zero changes all readings equally
  displaced,  ///< where the displacement is large, because the effect is proportional to the displacement
  held,       ///< where a pressure is held constant
  /// Where the input changes fast; the effect is proportional to the rate of the input and zero at rest.
  moving,
};

/// Input and predicted motion of the finger in one bin.
struct OperatingPoint {
  double pressure_kpa = 0;    ///< pressure that is the input of the finger
  double rate_kpa_per_s = 0;  ///< rate of the driving pressure after a peak detector (see rates_of()), >= 0
  double motion = 0;          ///< displacement that the model predicts, in the unit of the reading
};

/// Returns the rate |dp/dt| of the driving pressure at each sample [kPa/s], after a peak detector that decays
/// with a time constant of 0.5 s.
[[nodiscard]] std::vector<double> rates_of(const Record& record);

/// Returns, for each bin, true if the cause must have an effect in this bin. A pressure or rate counts as
/// zero if it is at most limits::rest_share of its range. A displacement or rate counts as high if it is in
/// the upper half of its range.
[[nodiscard]] std::vector<bool> required_at(Appears appears, const std::vector<OperatingPoint>& conditions);

/// Returns advice for the user if the data do not show a cause. The advice describes a recording in which the
/// cause would have an effect.
[[nodiscard]] std::string_view recording_for(Appears appears);

}  // namespace softgrip::sysid
