#pragma once
// Listening sockets.

#include <cstdint>
#include <string>

#include <tl/expected.hpp>

#include "base/descriptor.h"

namespace softgrip::modbus {

struct Listener {
  Descriptor socket;
  std::uint16_t port = 0;
};

/// Whether it is an IPv4 or IPv6 address in numbers.
[[nodiscard]] bool is_numeric(const std::string& address);

/// True for 127.0.0.0/8 and ::1.
[[nodiscard]] bool is_loopback(const std::string& address);

/// Listens on a numeric address; port 0 takes a free one. The error is one sentence.
[[nodiscard]] tl::expected<Listener, std::string> listen_tcp(const std::string& address, std::uint16_t port);

/// Listens on a Unix domain socket that only this user may open. A socket that is left over is replaced.
[[nodiscard]] tl::expected<Descriptor, std::string> listen_unix(const std::string& path);

/// The next client, not blocking and closed on exec; empty if there is none.
[[nodiscard]] Descriptor accept_client(const Descriptor& listener);

}  // namespace softgrip::modbus
