#pragma once
// Examines a rig through its running daemon. The daemon owns the board, so this module only reads the
// daemon's responses.

#include "tools/commissioning/finding.h"

namespace softgrip::tools::doctor {

/// Adds the findings about the daemon, its rig and its bus. `status` and `statistics` are the responses of
/// the daemon's socket. `rig` is the name of the rig in the given rig file, or empty if no rig file was
/// given.
void examine_daemon(const nlohmann::ordered_json& status, const nlohmann::ordered_json& statistics,
                    const std::string& rig, Findings& findings);

}  // namespace softgrip::tools::doctor
