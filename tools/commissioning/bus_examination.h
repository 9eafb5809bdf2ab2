#pragma once
// Tries other settings on a Modbus module that is not reached, or whose readings are not valid.

#include "tools/commissioning/finding.h"

namespace softgrip::rig {
struct RigFile;
}

namespace softgrip::tools::doctor {

/// Returns true if the board or a sensor has failed, so that other settings are worth a try.
[[nodiscard]] bool wants_bus_examination(const Findings& findings);

/// Reads the inputs of every module as the files describe them, on a session of its own. If no answer comes,
/// or a wired input is not valid, it tries other unit ids, addresses, counts, word orders and framings. Adds
/// the finding "modbus NAME" with the cause and the next step. Adds nothing if all wired inputs are valid, or
/// if the cause is not certain.
///
/// It only reads, and ends after 4 s. If reads feed the board's watchdog, the watchdog acts later by this
/// time. The rig's board must not be connected.
void examine_bus(const rig::RigFile& rig, Findings& findings);

}  // namespace softgrip::tools::doctor
