#pragma once
// Tests whether a model can explain the logs, and whether one model can fit all logs together.

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
/// rig was changed between two logs. Logs are inconsistent if fits of each log alone leave at most 10 % of
/// the mean square that a common fit leaves.
/// @param together_mm2  mean square of the common fit with the causes that were found. The causes are
/// included, because a drift also makes logs inconsistent but is explained by a cause.
[[nodiscard]] std::optional<std::string> inconsistent_among(const std::vector<Record>& records,
                                                            const StructureFit& recalibrated,
                                                            double together_mm2);

}  // namespace softgrip::sysid
