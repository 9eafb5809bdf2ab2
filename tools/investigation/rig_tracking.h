#pragma once
// The closed loop measured on a rig: the same sine tracked with one controller and with another.

#include <string>

#include <nlohmann/json_fwd.hpp>
#include <tl/expected.hpp>

#include "model/model.h"
#include "tools/investigation/closed_loop_gain.h"
#include "tools/investigation/experiment_rig.h"

namespace softgrip::tools {

/// Root mean square of reading minus reference over the measured cycles of a track step.
struct RigTracking {
  double recalibrated_rmse_mm = 0;
  double extended_rmse_mm = 0;
  int cycles = 0;
};

/// Tracks the gain's reference with its gains, twice, on one channel of the rig; recordings go into `folder`.
[[nodiscard]] tl::expected<RigTracking, NotPlayed> track_on_rig(
    const ExperimentRig& rig, const model::Model& recalibrated, const model::Model& extended,
    const ClosedLoopGain& gain, const std::string& folder, const Consent& consent);

/// Fills in "closed_loop.on_rig" of an investigation.json.
void add_rig_tracking(nlohmann::ordered_json& json, const RigTracking& tracking);

}  // namespace softgrip::tools
