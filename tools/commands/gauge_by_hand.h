#pragma once
// Checks the sensor of a real rig against a gauge. A person at the terminal holds the target.

#include <string>

#include "tools/investigation/experiment_rig.h"

namespace softgrip::tools {

/// Returns a function that reads the sensor through the board. The outputs stay at their lowest values, so
/// the rig moves nothing.
[[nodiscard]] GaugeTaker gauge_by_hand(ExperimentRig rig, Consent consent);

}  // namespace softgrip::tools
