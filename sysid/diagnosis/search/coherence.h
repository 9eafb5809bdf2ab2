#pragma once
// Tests whether a model fits the logs at all, and whether the logs are consistent with each other.

#include <optional>
#include <string>
#include <vector>

#include "sysid/diagnosis/search/fit.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Returns a warning if the refitted model explains less than 20 % of the variance of the readings.
[[nodiscard]] std::optional<std::string> why_not_about(const std::vector<Record>& records,
                                                       const StructureFit& recalibrated);

/// Returns a warning if the logs are inconsistent: they come from two rigs, or the rig changed between them.
/// Separate parameters for each log must then leave at most 10 % of the common mean square.
/// @param together_mm2  mean square of the common fit with the causes that were found. A drift makes logs
/// inconsistent too, but a cause explains it.
[[nodiscard]] std::optional<std::string> inconsistent_among(const std::vector<Record>& records,
                                                            const StructureFit& recalibrated,
                                                            double together_mm2);

}  // namespace softgrip::sysid
