#include "drivers/modbus/modbus_link.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>

#include "base/text.h"

namespace softgrip::drivers {
namespace {

// During an exchange, the deadline detects that the other end of the connection no longer responds. Between
// exchanges, these options let the kernel close a connection whose other end no longer responds.
constexpr int keepalive_idle_s = 2;
constexpr int keepalive_interval_s = 1;
constexpr int keepalive_probes = 3;
constexpr unsigned user_timeout_ms = 3000;

void set_option(int socket, int level, int name, int value) noexcept {
  // An error is ignored, because the connection works without these options. Without the options, the
  // connection is slower, or its failure is detected later.
  (void)::setsockopt(socket, level, name, &value, sizeof value);
}

/// Converts the host and the port of `from` to a socket address. Returns the size of the socket address; 0 if
/// the host is not a numeric address.
socklen_t parse_address(const TcpAddress& from, sockaddr_storage& address) noexcept {
  sockaddr_in v4{.sin_family = AF_INET, .sin_port = htons(from.port), .sin_addr = {}, .sin_zero = {}};
  sockaddr_in6 v6{};
  v6.sin6_family = AF_INET6;
  v6.sin6_port = v4.sin_port;
  if (::inet_pton(AF_INET, from.host.c_str(), &v4.sin_addr) == 1) {
    std::memcpy(&address, &v4, sizeof v4);
    return sizeof v4;
  }
  if (::inet_pton(AF_INET6, from.host.c_str(), &v6.sin6_addr) != 1) return 0;
  std::memcpy(&address, &v6, sizeof v6);
  return sizeof v6;
}

/// Returns true if a socket is connected to itself. This can happen if no program listens on the port of this
/// machine to which the socket connects. The kernel may then choose this port as the local port of the
/// socket.
bool talks_to_itself(int socket) noexcept {
  sockaddr_storage local{};
  sockaddr_storage peer{};
  socklen_t local_size = sizeof local;
  socklen_t peer_size = sizeof peer;
  return ::getsockname(socket, reinterpret_cast<sockaddr*>(&local), &local_size) == 0 &&
         ::getpeername(socket, reinterpret_cast<sockaddr*>(&peer), &peer_size) == 0 &&
         local_size == peer_size && std::memcmp(&local, &peer, local_size) == 0;
}

void set_options(int socket) noexcept {
  set_option(socket, IPPROTO_TCP, TCP_NODELAY, 1);
  set_option(socket, SOL_SOCKET, SO_KEEPALIVE, 1);
  set_option(socket, IPPROTO_TCP, TCP_KEEPIDLE, keepalive_idle_s);
  set_option(socket, IPPROTO_TCP, TCP_KEEPINTVL, keepalive_interval_s);
  set_option(socket, IPPROTO_TCP, TCP_KEEPCNT, keepalive_probes);
  set_option(socket, IPPROTO_TCP, TCP_USER_TIMEOUT, user_timeout_ms);
}

TcpConnection none(BusStatus status, const char* why) noexcept {
  return {Descriptor(), status, why};
}

}  // namespace

TcpConnection connect_tcp(const TcpAddress& to, Nanoseconds deadline) noexcept {
  sockaddr_storage address{};
  const socklen_t address_size = parse_address(to, address);
  if (address_size == 0) return none(BusStatus::disconnected, "not a numeric address");
  Descriptor opened(::socket(address.ss_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!opened) return none(BusStatus::disconnected, text_of_errno(errno));
  set_options(opened.get());
  if (::connect(opened.get(), reinterpret_cast<const sockaddr*>(&address), address_size) != 0 &&
      errno != EINPROGRESS) {
    return none(BusStatus::disconnected, text_of_errno(errno));
  }
  const Waited waited = wait_for(opened.get(), POLLOUT, deadline);
  if (waited == Waited::timed_out) return none(BusStatus::timed_out, "the deadline passed");
  if (waited == Waited::failed) return none(BusStatus::disconnected, text_of_errno(errno));
  int error = 0;
  socklen_t size = sizeof error;
  if (::getsockopt(opened.get(), SOL_SOCKET, SO_ERROR, &error, &size) != 0) error = errno;
  if (error == 0 && talks_to_itself(opened.get())) error = ECONNREFUSED;
  if (error != 0) return none(BusStatus::disconnected, text_of_errno(error));
  return {std::move(opened), BusStatus::ok, ""};
}

int send_whole(int socket, std::span<const std::uint8_t> frame) noexcept {
  // Only one request is sent at a time, and a request has at most 260 bytes. A socket that does not accept a
  // request at once is therefore blocked.
  const ssize_t sent = ::send(socket, frame.data(), frame.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  if (sent == static_cast<ssize_t>(frame.size())) return 0;
  return sent < 0 ? errno : ENOBUFS;
}

bool is_closed(int error) noexcept {
  return error == EPIPE || error == ECONNRESET;
}

}  // namespace softgrip::drivers
