#pragma once
// Tests if a model can explain the logs, and if one set of parameters fits all logs together.

#include <optional>
#include <string>
#include <vector>

#include "sysid/diagnosis/search/fit.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Returns a warning if the refitted model explains less than 20 % of the variance of the readings.
[[nodiscard]] std::optional<std::string> why_not_about(const std::vector<Record>& records,
                                                       const StructureFit& recalibrated);

/// Returns a warning if the logs are inconsistent, for example because they come from two rigs or because the
/// rig was changed between two logs. The structure is fitted to each log separately. The logs are
/// inconsistent if the mean square error of these fits is below 10 % of `together_mm2`.
/// @param together_mm2  mean square error of a common fit with all causes that were found. It includes the
/// causes because a drift, for example, makes logs differ, but is explained by a cause.
[[nodiscard]] std::optional<std::string> inconsistent_among(const std::vector<Record>& records,
                                                            const StructureFit& recalibrated,
                                                            double together_mm2);

}  // namespace softgrip::sysid
