#pragma once
// Formats an investigation as one HTML page with the experiments, the responses of the rig, and the result.

#include <string>

#include "tools/investigation/investigation.h"

namespace softgrip::tools {

/// Returns the HTML page.
/// @param rig          path of the rig file, or the command that plays the experiments
/// @param closed_loop  sentences about the closed loop; empty: no closed loop was simulated
[[nodiscard]] std::string investigation_html(const Investigation& investigation, const std::string& rig,
                                             const std::string& closed_loop);

}  // namespace softgrip::tools
