#pragma once
// Where the daemon of a rig listens, for who wants to talk to it.

#include <optional>
#include <string>

#include "document/problem.h"

namespace softgrip::rig {

/// `socket: path:` of a rig file, as seen from the working directory. Nothing else of the file is judged: a
/// daemon may run with what it was before. A file that cannot be read, or has no path, is a problem.
[[nodiscard]] std::optional<std::string> socket_path_of(const std::string& rig_path,
                                                        document::Problems& problems);

}  // namespace softgrip::rig
