#pragma once
// Checks that the computer can run the control loop on time and store recordings.

#include "tools/commissioning/finding.h"

namespace softgrip::rig {
struct RigFile;
}

namespace softgrip::tools::doctor {

/// Checks the kernel, the permissions for real-time scheduling and locked memory, and the timer. It requests
/// these permissions for this process and user, as the daemon would. Takes about 1 s.
void examine_machine(const rig::RigFile& rig, Findings& findings);
/// Checks that the clock is plausible and synchronised.
void examine_clock(Findings& findings);
/// Checks that the disk has space for recordings.
void examine_disk(const rig::RigFile& rig, Findings& findings);

}  // namespace softgrip::tools::doctor
