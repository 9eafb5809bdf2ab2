#pragma once
// The Unix domain sockets of the daemon; the `socket` map of a rig file.

#include <cstddef>
#include <string>

namespace softgrip::rig {

/// A Unix domain stream socket in the file system.
struct SocketFile {
  std::string path;  ///< empty: no socket
  /// Permissions of the file of the socket.
  unsigned mode = 0660;
  /// Group of the file of the socket; empty: the group of the daemon.
  std::string group;
};

/// The socket of the operators. Each client of this socket may move the gripper.
struct SocketSettings : SocketFile {
  SocketSettings() { path = "/run/softgrip/softgripd.sock"; }
  /// Socket of read-only clients.
  SocketFile look;
  /// Largest number of clients of each socket.
  std::size_t max_clients = 16;
  /// Longest line of a client [bytes]. After a longer line, the daemon sends an error and disconnects the
  /// client.
  std::size_t max_line_bytes = 64 * 1024;
  /// Largest amount of replies that a client has not read [bytes]. A client that exceeds it is disconnected.
  std::size_t max_queue_bytes = 1024 * 1024;
  /// Folder that contains the sequences that the request `start` can start.
  std::string sequence_directory = "/etc/softgrip/sequences";
};

}  // namespace softgrip::rig
