#pragma once
// What the computer itself must have for a punctual loop and a kept recording.

#include "tools/commissioning/finding.h"

namespace softgrip::rig {
struct RigFile;
}

namespace softgrip::tools::doctor {

/// Kernel, rights for scheduling and memory, timer; asks for them as the daemon would, for this process and
/// this user. Takes about a second.
void examine_machine(const rig::RigFile& rig, Findings& findings);
/// Whether the clock is set by anything.
void examine_clock(Findings& findings);
/// Whether recordings find room.
void examine_disk(const rig::RigFile& rig, Findings& findings);

}  // namespace softgrip::tools::doctor
