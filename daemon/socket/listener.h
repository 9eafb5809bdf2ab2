#pragma once
// A listening Unix domain socket and its file.

#include <sys/types.h>

#include <string>

#include <tl/expected.hpp>

#include "base/descriptor.h"
#include "rig/socket_settings.h"

namespace softgrip::daemon {

/// Returns a connection to the socket at `path` that does not block, or an empty descriptor.
[[nodiscard]] Descriptor connect_to(const std::string& path);

class Listener {
 public:
  /// Creates the socket's file, first with permissions for the owner only, then with those of `file`.
  /// Replaces the file of a daemon that has ended; the file of a running daemon is an error. The error is a
  /// sentence.
  [[nodiscard]] static tl::expected<Listener, std::string> open(const rig::SocketFile& file);
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;
  Listener(Listener&& other) noexcept = default;
  Listener& operator=(Listener&&) = delete;
  /// Removes the socket's file, if it is still the one that was created.
  ~Listener();

  [[nodiscard]] int get() const noexcept { return socket_.get(); }

 private:
  Listener(std::string path, Descriptor socket) : path_(std::move(path)), socket_(std::move(socket)) {}

  std::string path_;
  Descriptor socket_;
  dev_t device_ = 0;  // of the socket's file
  ino_t inode_ = 0;
};

}  // namespace softgrip::daemon
