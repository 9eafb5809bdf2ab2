#pragma once
// Examines the programs that connect clients to a running daemon: softgrip-plc and softgrip-web.

#include <string>

#include "tools/commissioning/finding.h"

namespace softgrip::tools::doctor {

/// Examines each program that systemd starts. A program is started if its unit is in `units`, the folder of
/// enabled systemd units. Checks that the program's file in `configuration` is valid and that a program
/// listens on the address in that file.
void examine_gateways(const std::string& units, const std::string& configuration, Findings& findings);

}  // namespace softgrip::tools::doctor
