#pragma once
// Creates listening sockets and accepts clients. A client can be accepted even if the process has no free
// descriptor.

#include <sys/un.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include <tl/expected.hpp>

#include "base/descriptor.h"
#include "base/time.h"

namespace softgrip::net {

struct Listener {
  Descriptor socket;
  std::uint16_t port = 0;
};

/// Returns true for a numeric IPv4 or IPv6 address.
[[nodiscard]] bool is_numeric(const std::string& address);

/// Returns the normal form of a numeric address. All notations of one address have the same normal form, for
/// example "::1" and "0:0::1", or "10.0.0.5" and "::ffff:10.0.0.5". Any other text is returned unchanged.
[[nodiscard]] std::string normal_address(const std::string& address);

/// Returns true for the loopback addresses 127.0.0.0/8 and ::1.
[[nodiscard]] bool is_loopback(const std::string& address);

/// Listens on a numeric address. Port 0 selects a free port. The error is one sentence.
[[nodiscard]] tl::expected<Listener, std::string> listen_tcp(const std::string& address, std::uint16_t port);

/// Returns the address of a socket file, or nothing if the path is too long for a socket.
[[nodiscard]] std::optional<sockaddr_un> unix_address(const std::string& path);

/// connect_unix() connects a socket to a socket file, and bind_unix() creates a socket file. Both return
/// false after an error and set errno. Only the present user may open the file that bind_unix() creates.
[[nodiscard]] bool connect_unix(const Descriptor& socket, const sockaddr_un& address) noexcept;
[[nodiscard]] bool bind_unix(const Descriptor& socket, const sockaddr_un& address) noexcept;

/// Largest number of clients that wait until they are accepted. If the queue is full, the kernel drops the
/// first packet of a client. The client then waits 1 s before it tries again.
inline constexpr int backlog = 128;

/// Listens on a Unix domain socket that only the present user may open. If a socket already exists at the
/// path, the new socket replaces it.
[[nodiscard]] tl::expected<Descriptor, std::string> listen_unix(const std::string& path);

/// Returns the descriptor of the next client; empty if no client waits. The descriptor does not block and is
/// closed on exec.
[[nodiscard]] Descriptor accept_client(const Descriptor& listener);

/// Returns true if `error` is an error of accept_client() that means that no descriptor is free.
[[nodiscard]] bool is_descriptor_shortage(int error) noexcept;

/// Accepts clients. If no descriptor is free, a waiting client cannot be accepted, and each poll() returns at
/// once. A server that polled continuously would use a complete processor core. Therefore, the listener
/// pauses. Before the pause, it closes its spare descriptors and accepts one client, because this client may
/// want to stop the rig.
class Acceptor {
 public:
  /// Duration of a pause, after which the acceptor tries to accept clients again [ns].
  static constexpr Nanoseconds retry_pause = ns_per_s / 10;

  Acceptor() = default;
  /// @param listener  a socket from listen_tcp() or listen_unix(); if it is empty, no client is accepted.
  explicit Acceptor(Descriptor listener);

  /// Returns the descriptor for poll(); -1 while the acceptor pauses.
  [[nodiscard]] int descriptor(Nanoseconds now) const noexcept {
    return now < paused_until_ ? -1 : listener_.get();
  }
  /// Returns the next client, as accept_client() does. Returns an empty descriptor if no client waits, or if
  /// no descriptor is free for a client.
  [[nodiscard]] Descriptor accept(Nanoseconds now);
  /// Returns true if the last accept() found no free descriptor. In this case, the caller should close
  /// descriptors that it does not need.
  [[nodiscard]] bool out_of_descriptors() const noexcept { return out_of_descriptors_; }

 private:
  void reserve_spares() noexcept;

  Descriptor listener_;
  /// Spare descriptors that are closed to accept a client: one for the client, and one that the request of
  /// this client may need.
  std::array<Descriptor, 2> spares_;
  Nanoseconds paused_until_ = 0;
  bool out_of_descriptors_ = false;
};

}  // namespace softgrip::net
