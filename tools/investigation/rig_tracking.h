#pragma once
// Measures the closed loop on a rig. The rig tracks the same sine twice, once with each of two controllers.

#include <string>

#include <tl/expected.hpp>

#include "base/result/result.h"
#include "model/model.h"
#include "tools/investigation/closed_loop_gain.h"
#include "tools/investigation/experiment_rig.h"

namespace softgrip::tools {

/// RMS difference between reading and reference over the measured cycles of a track step [mm], for each of
/// the two controllers.
struct RigTracking {
  double recalibrated_rmse_mm = 0;
  double extended_rmse_mm = 0;
  int cycles = 0;
};

/// Tracks the reference of `gain` on one channel of the rig twice: with the controller for the refitted model
/// and with the controller for the extended model. Recordings are written to `folder`.
[[nodiscard]] tl::expected<RigTracking, NotPlayed> track_on_rig(
    const ExperimentRig& rig, const model::Model& recalibrated, const model::Model& extended,
    const ClosedLoopGain& gain, const std::string& folder, const Consent& consent);

/// Returns the value of the key "closed_loop.on_rig" of investigation.json.
[[nodiscard]] result::Fields fields_of(const RigTracking& tracking);

}  // namespace softgrip::tools
