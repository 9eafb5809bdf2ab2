#pragma once
// What a running daemon says of itself: then the board is its own, and nobody else touches it.

#include "tools/commissioning/finding.h"

namespace softgrip::tools::doctor {

/// `status` and `statistics` as its socket answers them; `rig` is the name in the rig file that was given,
/// empty if none was.
void examine_daemon(const nlohmann::ordered_json& status, const nlohmann::ordered_json& statistics,
                    const std::string& rig, Findings& findings);

}  // namespace softgrip::tools::doctor
