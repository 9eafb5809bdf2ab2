#pragma once
// Examines the board, sensors and valves of a rig while no daemon runs.

#include "tools/commissioning/finding.h"
#include "tools/commissioning/motion_session.h"

namespace softgrip::rig {
struct RigFile;
}

namespace softgrip::tools::doctor {

/// Sizes and durations of the motions.
struct MoveSettings {
  double share = 0.25;    ///< commanded step, as a share of the pressure range on the larger side of rest
  double duration_s = 1;  ///< duration of the ramp up, if the slew limits allow it, and of the ramp down
  double settle_s = 1;    ///< wait after the ramp up, and after the ramp down
  double look_s = 1;      ///< duration of the readings at rest, before the first motion
};

/// Examines board, watchdog, bus budget and sensors. With `move`, moves each finger a little and compares the
/// motion with the finger's model. Leaves the channels at their rest pressures. An examination that the user
/// stops counts as a failure.
void examine_rig(const rig::RigFile& rig, drivers::Board& board, const Clock& clock, StopRequest stop,
                 bool move, const MoveSettings& settings, Findings& findings);

/// Examines the digital lines: requests them from the system, reads them and releases them. The outputs are
/// inactive during this time.
void examine_gpio(const rig::RigFile& rig, Findings& findings);

/// Examines the bus budget and the watchdog from the files alone, without an exchange with the board.
void examine_description(const rig::RigFile& rig, const drivers::Board& board, Findings& findings);

}  // namespace softgrip::tools::doctor
