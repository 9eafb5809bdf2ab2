#pragma once
// Creates listening sockets and accepts clients.

#include <sys/un.h>

#include <cstdint>
#include <optional>
#include <string>

#include <tl/expected.hpp>

#include "base/descriptor.h"

namespace softgrip::net {

struct Listener {
  Descriptor socket;
  std::uint16_t port = 0;
};

/// Returns true for a numeric IPv4 or IPv6 address.
[[nodiscard]] bool is_numeric(const std::string& address);

/// Returns true for the loopback addresses 127.0.0.0/8 and ::1.
[[nodiscard]] bool is_loopback(const std::string& address);

/// Listens on a numeric address. Port 0 selects a free port. The error is one sentence.
[[nodiscard]] tl::expected<Listener, std::string> listen_tcp(const std::string& address, std::uint16_t port);

/// Returns the address of a socket file, or nothing if the path is too long for a socket.
[[nodiscard]] std::optional<sockaddr_un> unix_address(const std::string& path);

/// These functions set errno if they return false. Only this user may open the file that bind_unix() creates.
[[nodiscard]] bool connect_unix(const Descriptor& socket, const sockaddr_un& address) noexcept;
[[nodiscard]] bool bind_unix(const Descriptor& socket, const sockaddr_un& address) noexcept;

/// Largest number of clients that wait until they are accepted. If the queue is full, the kernel drops the
/// first packet of a client. The client then waits 1 s before it tries again.
inline constexpr int backlog = 128;

/// Listens on a Unix domain socket that only this user may open. If a socket already exists at the path, it
/// is replaced.
[[nodiscard]] tl::expected<Descriptor, std::string> listen_unix(const std::string& path);

/// Returns the descriptor of the next client; empty if no client waits. The descriptor does not block and is
/// closed on exec.
[[nodiscard]] Descriptor accept_client(const Descriptor& listener);

/// Returns true if accept_client() failed with this error because no descriptor is free.
[[nodiscard]] bool is_shortage(int error) noexcept;

}  // namespace softgrip::net
