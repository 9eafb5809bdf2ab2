#pragma once
// Lists the parameters that a fit cannot determine because the logs lack the necessary motion.

#include <string>
#include <vector>

#include "sysid/identification/identify.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// Returns one sentence for each type of motion that no log contains. The sentence names the fitted
/// parameters that cannot be determined without this type of motion.
[[nodiscard]] std::vector<std::string> excitation_limits(const std::vector<Log>& logs,
                                                         const std::vector<Estimate>& parameters);

}  // namespace softgrip::sysid
