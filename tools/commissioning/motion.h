#pragma once
// A small motion of one finger, and what it tells of valve, line, sensor and model.

#include "tools/commissioning/rig_examination.h"

namespace softgrip::tools::doctor {

/// What was seen while one finger went up a little and came back.
struct Motion {
  double command_kpa = 0;      ///< how far up
  ChannelSample up;            ///< while it stood there
  double model_mm = 0;         ///< how far the model moved, up there
  double residual_rms_mm = 0;  ///< of reading minus model, less what it was at rest; over the whole motion
};

[[nodiscard]] HandDrive::Expected<Motion> move_and_watch(const rig::RigFile& rig, HandDrive& drive,
                                                         std::size_t channel, const ChannelSample& rest,
                                                         const MoveSettings& settings);
/// Valve follows, sensor follows, model fits; `rest` is what was read before.
void judge_motion(const rig::RigFile& rig, std::size_t channel, const ChannelSample& rest,
                  const Motion& motion, Findings& findings);

}  // namespace softgrip::tools::doctor
