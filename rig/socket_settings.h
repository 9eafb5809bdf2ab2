#pragma once
// The local socket through which status is read and requests are made; the `socket` map of a rig file.

#include <cstddef>
#include <string>

namespace softgrip::rig {

/// A Unix domain stream socket in the file system.
struct SocketFile {
  std::string path;  ///< empty: none
  /// Permissions of its file.
  unsigned mode = 0660;
  /// Group of its file; empty: the daemon's.
  std::string group;
};

/// The file is the socket of those who may operate: who may connect may move the gripper.
struct SocketSettings : SocketFile {
  SocketSettings() { path = "/run/softgrip/softgripd.sock"; }
  /// Who connects here may only look.
  SocketFile look;
  /// Of each of the two.
  std::size_t max_clients = 16;
  /// Longest line a client may send [bytes]; a longer one is answered and the client dropped.
  std::size_t max_line_bytes = 64 * 1024;
  /// Replies waiting for a client that does not read [bytes]; beyond it the client is dropped.
  std::size_t max_queue_bytes = 1024 * 1024;
  /// Folder in which `start` looks for sequences named by a client.
  std::string sequence_directory = "/etc/softgrip/sequences";
};

}  // namespace softgrip::rig
