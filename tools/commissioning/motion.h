#pragma once
// A small motion of one finger, and what it tells of valve, line, sensor and model.

#include "tools/commissioning/rig_examination.h"

namespace softgrip::tools::doctor {

/// What was seen while one finger went a little away from rest and came back.
struct Motion {
  double command_kpa = 0;         ///< how far
  std::vector<ChannelSample> up;  ///< of all channels, while this one stood there; empty: it was not moved
  double model_mm = 0;            ///< how far the model moved, up there
  double residual_rms_mm = 0;     ///< of reading minus model, less what it was at rest; over the whole motion
};

[[nodiscard]] MotionSession::Expected<Motion> move_and_watch(const rig::RigFile& rig, MotionSession& session,
                                                             std::size_t channel, const ChannelSample& rest,
                                                             const MoveSettings& settings);
/// True of a sensor that went far enough from its rest: beyond its noise, and for a good part of what the
/// model of the finger that was moved went.
[[nodiscard]] bool has_moved(const Sample& rest, const Sample& seen, double model_mm);

/// What is known to be wrong with a channel before its motion is judged: a sentence of why, or empty.
struct NotJudged {
  std::string valve;   ///< the valve cannot be judged by its monitor
  std::string finger;  ///< the finger and its model cannot be judged
};
/// Valve follows, sensor follows, model fits; `rest` is what was read before. What follows from something
/// that has been found already is not judged.
void judge_motion(const rig::RigFile& rig, std::size_t channel, const ChannelSample& rest,
                  const Motion& motion, const NotJudged& known, Findings& findings);

}  // namespace softgrip::tools::doctor
