#pragma once
// Checks if a daemon is running behind a socket. Another program can listen there, and a stopped daemon still
// accepts connections.

#include <string>

namespace softgrip::daemon {

/// Requests the status and waits at most 2 s. Returns true if a trusted program (trusted_user.h) replied as
/// softgripd does.
[[nodiscard]] bool daemon_answers(const std::string& socket_path);

}  // namespace softgrip::daemon
