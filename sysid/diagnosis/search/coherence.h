#pragma once
// Whether logs belong to a model at all, and to each other.

#include <optional>
#include <string>
#include <vector>

#include "sysid/diagnosis/search/fit.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// A sentence where a recalibrated model is not about these readings: it explains less than a fifth of their
/// variance.
[[nodiscard]] std::optional<std::string> why_not_about(const std::vector<Record>& records,
                                                       const StructureFit& recalibrated);

/// A sentence where several logs are each explained far better (a tenth of the mean square) by numbers of
/// their own than by common ones: logs of two rigs, or of one that was changed.
/// @param together_mm2  what common numbers leave, with the causes that were found: a drift too makes
/// strangers
///                      of logs, and explains them.
[[nodiscard]] std::optional<std::string> strangers_among(const std::vector<Record>& records,
                                                         const StructureFit& recalibrated,
                                                         double together_mm2);

}  // namespace softgrip::sysid
