#pragma once
// Which parameters a fit cannot know, because the logs do not excite them.

#include <string>
#include <vector>

#include "sysid/identification/identify.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// A sentence for each excitation that none of the logs contains, with the free parameters that need it.
[[nodiscard]] std::vector<std::string> excitation_limits(const std::vector<Log>& logs,
                                                         const std::vector<Estimate>& parameters);

}  // namespace softgrip::sysid
