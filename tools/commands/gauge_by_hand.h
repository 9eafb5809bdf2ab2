#pragma once
// The sensor of a real rig against a gauge, with somebody at the terminal who holds the target.

#include <string>

#include "tools/investigation/experiment_rig.h"

namespace softgrip::tools {

/// Reads the sensor through the board. The outputs stay at their lowest; nothing moves by itself.
[[nodiscard]] GaugeTaker gauge_by_hand(ExperimentRig rig, Consent consent);

}  // namespace softgrip::tools
