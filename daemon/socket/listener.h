#pragma once
// A Unix domain socket that accepts connections, and the file of this socket.

#include <sys/types.h>

#include <string>

#include <tl/expected.hpp>

#include "base/descriptor.h"
#include "rig/daemon_settings.h"

namespace softgrip::daemon {

/// Connects to the socket at `path`. Returns a descriptor in non-blocking mode, or an empty descriptor after
/// a failure.
[[nodiscard]] Descriptor connect_to(const std::string& path);

class Listener {
 public:
  /// Creates the socket file. At first only its owner has permissions; after the socket listens, the file has
  /// the permissions in `file`. If the file exists and its daemon has ended, the file is replaced. If its
  /// daemon runs, this is an error. The error is a sentence.
  [[nodiscard]] static tl::expected<Listener, std::string> open(const rig::SocketFile& file);
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;
  Listener(Listener&& other) noexcept = default;
  Listener& operator=(Listener&&) = delete;
  /// Removes the socket file if this object created it and no other daemon has replaced it.
  ~Listener();

  [[nodiscard]] const Descriptor& socket() const noexcept { return socket_; }

 private:
  Listener(std::string path, Descriptor socket) : path_(std::move(path)), socket_(std::move(socket)) {}

  std::string path_;
  Descriptor socket_;
  dev_t device_ = 0;  // device and inode of the socket file
  ino_t inode_ = 0;
};

}  // namespace softgrip::daemon
