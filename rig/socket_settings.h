#pragma once
// The settings in the `socket` map of a rig file: the Unix domain sockets of the daemon.

#include <cstddef>
#include <string>

namespace softgrip::rig {

/// The file of a Unix domain stream socket.
struct SocketFile {
  std::string path;  ///< path of the socket file; empty: there is no such socket
  /// Permissions of the socket file (file mode).
  unsigned mode = 0660;
  /// Group of the socket file; empty: the group of the daemon.
  std::string group;
};

/// The socket for clients that may move the gripper, and the settings for both sockets. rig/rig_keys.cpp
/// declares the meaning and the range of each member.
struct SocketSettings : SocketFile {
  SocketSettings() { path = "/run/softgrip/softgripd.sock"; }
  /// The socket for read-only clients.
  SocketFile look;
  std::size_t max_clients = 16;
  std::size_t max_line_bytes = 64 * 1024;
  std::size_t max_queue_bytes = 1024 * 1024;
  /// Folder with the sequences that clients can start by name.
  std::string sequence_directory = "/etc/softgrip/sequences";
};

}  // namespace softgrip::rig
