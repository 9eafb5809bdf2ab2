#pragma once
// The local socket through which status is read and requests are made; the `socket` map of a rig file.

#include <cstddef>
#include <string>

namespace softgrip::rig {

struct SocketSettings {
  /// A Unix domain stream socket; empty: none.
  std::string path = "/run/softgrip/softgripd.sock";
  /// Permissions of the socket's file: who may connect may move the gripper.
  unsigned mode = 0660;
  /// Group of the socket's file; empty: the daemon's.
  std::string group;
  std::size_t max_clients = 16;
  /// Longest line a client may send [bytes]; a longer one is answered and the client dropped.
  std::size_t max_line_bytes = 64 * 1024;
  /// Replies waiting for a client that does not read [bytes]; beyond it the client is dropped.
  std::size_t max_queue_bytes = 1024 * 1024;
  /// Folder in which `start` looks for sequences named by a client.
  std::string sequence_directory = "/etc/softgrip/sequences";
};

}  // namespace softgrip::rig
