#pragma once
// Finds the socket of the daemon that runs a rig. The clients of the daemon use this function.

#include <optional>
#include <string>

#include "document/problem.h"

namespace softgrip::rig {

/// Returns the value of `socket: path:` in a rig file, as a path relative to the working directory. The other
/// keys of the file are not checked, because the daemon may run with an earlier version of the file. If the
/// file cannot be read or has no such path, a problem is reported.
[[nodiscard]] std::optional<std::string> socket_path_of(const std::string& rig_path,
                                                        document::Problems& problems);

}  // namespace softgrip::rig
