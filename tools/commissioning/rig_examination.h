#pragma once
// What the board, the sensors and the valves of a rig say to somebody who asks without a daemon.

#include "tools/commissioning/finding.h"
#include "tools/commissioning/motion_session.h"

namespace softgrip::rig {
struct RigFile;
}

namespace softgrip::tools::doctor {

/// The shares of the limits that the examination by motion uses.
struct MoveSettings {
  double share = 0.25;    ///< of the pressure range on the larger side of rest
  double duration_s = 1;  ///< of the way up, if the limits allow it, and of the way down
  double settle_s = 1;    ///< up there, and down again
  double look_s = 1;      ///< at rest, before anything moves
};

/// Board, watchdog, bus budget, sensors; with `move` each finger is moved a little and must follow, as its
/// model does. Leaves the rest pressures. What the user stopped is a failure.
void examine_rig(const rig::RigFile& rig, drivers::Board& board, const Clock& clock, StopRequest stop,
                 bool move, const MoveSettings& settings, Findings& findings);

/// The digital lines: requested, read, given back. Outputs are inactive meanwhile.
void examine_gpio(const rig::RigFile& rig, Findings& findings);

/// What needs no board to be asked: the bus budget and the watchdog, as the files describe them.
void examine_description(const rig::RigFile& rig, const drivers::Board& board, Findings& findings);

}  // namespace softgrip::tools::doctor
