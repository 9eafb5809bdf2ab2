#pragma once
// Whether a daemon lives behind a socket. Another program can listen there, and a daemon that is stopped
// still accepts connections.

#include <string>

namespace softgrip::daemon {

/// Asks for the status and waits at most 2 s. True if a trusted program (trusted_user.h) replied as softgripd
/// does.
[[nodiscard]] bool daemon_answers(const std::string& socket_path);

}  // namespace softgrip::daemon
