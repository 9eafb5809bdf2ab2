#pragma once
// Examines the board, sensors and valves of a rig while no daemon runs.

#include "tools/commissioning/finding.h"
#include "tools/commissioning/motion_session.h"

namespace softgrip::rig {
struct RigFile;
}

namespace softgrip::tools::doctor {

/// Sizes and durations of the motions of an examination.
struct MoveSettings {
  double share = 0.25;    ///< commanded step, as a share of the distance from the rest pressure to the
                          ///< pressure limit that is further from it
  double duration_s = 1;  ///< duration of the ramp up and of the ramp down [s]; longer if the slew limits
                          ///< require it
  double settle_s = 1;    ///< wait after the ramp up and after the ramp down [s]
  double look_s = 1;      ///< duration of the readings at rest before the first motion [s]
};

/// Examines board, watchdog, bus budget and sensors. With `move`, moves each finger a little and compares the
/// motion with the finger's model. At the end, the channels are at their rest pressures. If the user stops
/// the examination, this counts as a failure.
void examine_rig(const rig::RigFile& rig, drivers::Board& board, const Clock& clock, StopRequest stop,
                 bool move, const MoveSettings& settings, Findings& findings);

/// Examines the digital lines: requests them from the operating system, reads them and releases them. The
/// digital outputs are inactive during this time.
void examine_gpio(const rig::RigFile& rig, Findings& findings);

/// Examines the bus budget and the watchdog from the rig and board files, without an exchange with the board.
void examine_description(const rig::RigFile& rig, const drivers::Board& board, Findings& findings);

}  // namespace softgrip::tools::doctor
