#pragma once
// Checks valve, line, sensor and model by a small motion of one finger.

#include "tools/commissioning/rig_examination.h"

namespace softgrip::tools::doctor {

/// The measurements of one finger's small motion from rest and back.
struct Motion {
  double command_kpa = 0;         ///< command at the end of the ramp away from rest [kPa]
  std::vector<ChannelSample> up;  ///< readings of all channels at this command; empty: not moved
  double model_mm = 0;            ///< displacement of the model at this command [mm]
  double residual_rms_mm = 0;     ///< RMS of reading minus model over the whole motion, both relative to rest
};

[[nodiscard]] MotionSession::Expected<Motion> move_and_watch(const rig::RigFile& rig, MotionSession& session,
                                                             std::size_t channel, const ChannelSample& rest,
                                                             const MoveSettings& settings);
/// Returns true if the sensor moved from its rest value by more than a multiple of its noise and by more than
/// a minimum share of `model_mm`, the displacement that the model predicts for the moved finger.
[[nodiscard]] bool has_moved(const Sample& rest, const Sample& seen, double model_mm);

/// Reasons why a channel's motion cannot be judged. Empty: it can be judged.
struct NotJudged {
  std::string valve;   ///< why the valve cannot be judged by its monitor
  std::string finger;  ///< why the finger and its model cannot be judged
};
/// Checks that the pressure follows the command, that the sensor shows the motion and that the model fits.
/// `rest` contains the readings before the motion. A check that depends on a known problem (`known`) is
/// reported as not judged.
void judge_motion(const rig::RigFile& rig, std::size_t channel, const ChannelSample& rest,
                  const Motion& motion, const NotJudged& known, Findings& findings);

}  // namespace softgrip::tools::doctor
