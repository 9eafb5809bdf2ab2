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
  double share = 0.25;    ///< of the pressure range on the larger side of rest
  double duration_s = 1;  ///< of the ramp up, if the slew limits allow it, and of the ramp down
  double settle_s = 1;    ///< at the far end, and after the return
  double look_s = 1;      ///< duration of the readings at rest, before the first motion
};

/// Examines board, watchdog, bus budget and sensors. With `move`, each finger is moved a little and compared
/// with its model. Leaves the rest pressures. An examination that the user stopped is a failure.
void examine_rig(const rig::RigFile& rig, drivers::Board& board, const Clock& clock, StopRequest stop,
                 bool move, const MoveSettings& settings, Findings& findings);

/// Examines the digital lines: requests them, reads them and returns them. Outputs are inactive meanwhile.
void examine_gpio(const rig::RigFile& rig, Findings& findings);

/// Examines the parts that need no exchange with the board: the bus budget and the watchdog according to the
/// files.
void examine_description(const rig::RigFile& rig, const drivers::Board& board, Findings& findings);

}  // namespace softgrip::tools::doctor
