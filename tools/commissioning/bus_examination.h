#pragma once
// Tries other settings on a Modbus module that does not respond or has invalid readings.

#include "tools/commissioning/finding.h"

namespace softgrip::rig {
struct RigFile;
}

namespace softgrip::tools::doctor {

/// Returns true if the findings contain a failure of the board or of a sensor. Other settings of the module
/// may then work.
[[nodiscard]] bool wants_bus_examination(const Findings& findings);

/// Reads the inputs of every module with the settings of the files, in a separate session. If the module does
/// not respond, or if a wired input is invalid, it tries other unit ids, addresses, numbers of registers,
/// word orders and framings. Adds the finding "modbus NAME" with the cause and the next step. Adds nothing if
/// all wired inputs are valid, or if the cause is not certain.
///
/// Writes nothing to the module and ends after 4 s. If read requests reset the board's watchdog, they delay
/// its trip by this time. The rig's board must not be connected.
void examine_bus(const rig::RigFile& rig, Findings& findings);

}  // namespace softgrip::tools::doctor
