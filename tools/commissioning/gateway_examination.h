#pragma once
// The programs in front of a running daemon: softgrip-plc and softgrip-web.

#include <string>

#include "tools/commissioning/finding.h"

namespace softgrip::tools::doctor {

/// Looks at those that are enabled: whether `units` (the folder of what the system starts) names them, their
/// files in `configuration` can be used, and somebody listens where those say.
void examine_gateways(const std::string& units, const std::string& configuration, Findings& findings);

}  // namespace softgrip::tools::doctor
