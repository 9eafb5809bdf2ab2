#pragma once
// Finds the socket of a rig's daemon, for its clients.

#include <optional>
#include <string>

#include "document/problem.h"

namespace softgrip::rig {

/// Returns `socket: path:` of a rig file, relative to the working directory. The rest of the file is not
/// checked, because the daemon may run with an earlier version. A file that cannot be read or has no path is
/// reported.
[[nodiscard]] std::optional<std::string> socket_path_of(const std::string& rig_path,
                                                        document::Problems& problems);

}  // namespace softgrip::rig
