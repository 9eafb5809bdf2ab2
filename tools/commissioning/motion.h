#pragma once
// Judges valve, line, sensor and model by a small motion of one finger.

#include "tools/commissioning/rig_examination.h"

namespace softgrip::tools::doctor {

/// The measurements of one finger's small motion from rest and back.
struct Motion {
  double command_kpa = 0;         ///< command at the far end [kPa]
  std::vector<ChannelSample> up;  ///< readings of all channels at the far end; empty: not moved
  double model_mm = 0;            ///< displacement of the model at the far end [mm]
  double residual_rms_mm = 0;     ///< RMS of reading minus model, relative to rest, over the whole motion
};

[[nodiscard]] MotionSession::Expected<Motion> move_and_watch(const rig::RigFile& rig, MotionSession& session,
                                                             std::size_t channel, const ChannelSample& rest,
                                                             const MoveSettings& settings);
/// Returns true if the sensor moved from its rest value by more than its noise and by a minimum share of
/// `model_mm`, the displacement of the moved finger's model.
[[nodiscard]] bool has_moved(const Sample& rest, const Sample& seen, double model_mm);

/// Reasons why a channel's motion cannot be judged. An empty text means that it can.
struct NotJudged {
  std::string valve;   ///< why the valve cannot be judged by its monitor
  std::string finger;  ///< why the finger and its model cannot be judged
};
/// Checks that the valve follows, the sensor follows and the model fits. `rest` contains the readings before
/// the motion. Findings that are consequences of known problems (`known`) are reported as not judged.
void judge_motion(const rig::RigFile& rig, std::size_t channel, const ChannelSample& rest,
                  const Motion& motion, const NotJudged& known, Findings& findings);

}  // namespace softgrip::tools::doctor
