#pragma once
// An investigation as one page: what was asked, what the rig answered, what stands in the end.

#include <string>

#include "tools/investigation/investigation.h"

namespace softgrip::tools {

/// @param rig  what the experiments were played on
/// @param closed_loop  sentences about the gain in closed loop; empty: it was not measured
[[nodiscard]] std::string investigation_html(const Investigation& investigation, const std::string& rig,
                                             const std::string& closed_loop);

}  // namespace softgrip::tools
