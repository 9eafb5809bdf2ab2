#pragma once
// Decides which users a softgrip program trusts to drive a board. This is necessary because any user may bind
// any socket name.

#include <sys/types.h>

#include <optional>

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

}  // namespace softgrip::daemon
