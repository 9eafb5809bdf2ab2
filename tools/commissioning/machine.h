#pragma once
// Checks that the computer can run the control loop without delays and store recordings.

#include "tools/commissioning/finding.h"

namespace softgrip::rig {
struct RigFile;
}

namespace softgrip::tools::doctor {

/// Checks the kernel, the permissions for real-time scheduling and locked memory, and the timer. Requests
/// these permissions for this process and its user, as the daemon does. Takes about 1 s.
void examine_machine(const rig::RigFile& rig, Findings& findings);
/// Checks that the clock is plausible and synchronised.
void examine_clock(Findings& findings);
/// Checks that the disk has enough space for the recordings of the rig.
void examine_disk(const rig::RigFile& rig, Findings& findings);

}  // namespace softgrip::tools::doctor
