#pragma once
// Decides which users a softgrip program trusts to drive a board. This is necessary because any user may bind
// any socket name.
// Checks if a running daemon replies on a socket. An accepted connection does not prove this: another program
// can listen on the socket, and a stopped daemon also accepts connections.

#include <sys/types.h>

#include <optional>
#include <string>

namespace softgrip::daemon {

/// The user and the group of the service.
inline constexpr const char* service_account = "softgrip";

/// Returns the user id of the service; nothing if this machine has no such user.
[[nodiscard]] std::optional<uid_t> service_user();

/// Returns true if the user is root, the user of the service, or the user of this process.
[[nodiscard]] bool is_trusted(uid_t user);

/// The process at the other end of a Unix domain socket. The kernel stored these data at connect() or
/// listen().
struct Peer {
  pid_t process = 0;  ///< process id; 0: this process cannot see the process at the other end
  uid_t user = 0;
  /// true: the process belongs to a trusted user, or to a member of the service's group; these users may move
  /// the gripper
  bool trusted = false;
};
/// Returns the process at the other end of a connected socket; empty if the kernel does not report it.
[[nodiscard]] std::optional<Peer> peer_of(int socket);

/// Requests the status and waits at most 2 s for the reply. Returns true if a trusted program
/// (trusted_user.h) replied in the way softgripd does.
[[nodiscard]] bool daemon_answers(const std::string& socket_path);

}  // namespace softgrip::daemon
