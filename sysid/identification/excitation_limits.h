#pragma once
// Names the parameters that a fit cannot determine because the logs do not excite them.

#include <string>
#include <vector>

#include "sysid/identification/identify.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// Returns a sentence for each excitation that no log contains, with the fitted parameters that need it.
[[nodiscard]] std::vector<std::string> excitation_limits(const std::vector<Log>& logs,
                                                         const std::vector<Estimate>& parameters);

}  // namespace softgrip::sysid
