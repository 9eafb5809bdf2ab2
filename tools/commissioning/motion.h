#pragma once
// Checks the valve, the line, the sensor and the model of a finger by a small motion.

#include "tools/commissioning/examinations.h"

namespace softgrip::tools::doctor {

/// The measurements of a small motion of one finger, from rest and back to rest.
struct Motion {
  double command_kpa = 0;         ///< command at the end of the ramp away from rest [kPa]
  std::vector<ChannelSample> up;  ///< readings of all channels at this command; empty: the channel was not
                                  ///< moved
  double model_mm = 0;            ///< displacement that the model predicts at this command [mm]
  double residual_rms_mm = 0;     ///< RMS difference between reading and model over the whole motion, both
                                  ///< relative to rest
};

[[nodiscard]] MotionSession::Expected<Motion> move_and_watch(const rig::RigFile& rig, MotionSession& session,
                                                             std::size_t channel, const ChannelSample& rest,
                                                             const MoveSettings& settings);
/// Returns true if the displacement of the sensor from rest exceeds two thresholds: a multiple of its noise,
/// and a share of `model_mm`, the displacement that the model predicts.
[[nodiscard]] bool has_moved(const Sample& rest, const Sample& seen, double model_mm);

/// Reasons why the motion of a channel cannot be checked. An empty text means that the check is possible.
struct NotJudged {
  std::string valve;   ///< reason why the pressure monitor cannot check the valve
  std::string finger;  ///< reason why the finger and its model cannot be checked
};
/// Checks that the pressure follows the command, that the sensor shows the motion, and that the model
/// predicts it. `rest` contains the readings before the motion. `known` contains known problems; a check that
/// depends on one of them is reported as not judged.
void judge_motion(const rig::RigFile& rig, std::size_t channel, const ChannelSample& rest,
                  const Motion& motion, const NotJudged& known, Findings& findings);

}  // namespace softgrip::tools::doctor
