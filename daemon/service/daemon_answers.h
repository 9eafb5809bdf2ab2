#pragma once
// Checks if a running daemon replies on a socket. An accepted connection does not prove this: another program
// can listen on the socket, and a stopped daemon also accepts connections.

#include <string>

namespace softgrip::daemon {

/// Requests the status and waits at most 2 s for the reply. Returns true if a trusted program
/// (trusted_user.h) replied in the way softgripd does.
[[nodiscard]] bool daemon_answers(const std::string& socket_path);

}  // namespace softgrip::daemon
