#include "drivers/modbus/modbus_tcp_link.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "base/clock.h"
#include "base/descriptor_wait.h"
#include "base/errno_text.h"
#include "drivers/modbus/exception_text.h"

namespace softgrip::drivers {
namespace {

static_assert(sizeof(sockaddr_storage) <= 128);

// A dead peer is noticed by the exchange's own deadline; these only keep the kernel from holding on to a
// connection whose other end is gone while nobody asks anything.
constexpr int keepalive_idle_s = 2;
constexpr int keepalive_interval_s = 1;
constexpr int keepalive_probes = 3;
constexpr unsigned user_timeout_ms = 3000;

void set_option(int socket, int level, int name, int value) noexcept {
  // Best effort: a session without these options is slower or later noticed dead, not wrong.
  (void)::setsockopt(socket, level, name, &value, sizeof value);
}

std::uint32_t parse_address(const std::string& host, std::uint16_t port, std::uint8_t* storage) {
  sockaddr_in v4{};
  if (::inet_pton(AF_INET, host.c_str(), &v4.sin_addr) == 1) {
    v4.sin_family = AF_INET;
    v4.sin_port = htons(port);
    std::memcpy(storage, &v4, sizeof v4);
    return sizeof v4;
  }
  sockaddr_in6 v6{};
  if (::inet_pton(AF_INET6, host.c_str(), &v6.sin6_addr) == 1) {
    v6.sin6_family = AF_INET6;
    v6.sin6_port = htons(port);
    std::memcpy(storage, &v6, sizeof v6);
    return sizeof v6;
  }
  return 0;
}

/// A connection attempt to a port of this machine where nobody listens can be answered by its own socket,
/// when the kernel happens to pick that port as the local one.
bool talks_to_itself(int socket) noexcept {
  sockaddr_storage local{};
  sockaddr_storage peer{};
  socklen_t local_size = sizeof local;
  socklen_t peer_size = sizeof peer;
  return ::getsockname(socket, reinterpret_cast<sockaddr*>(&local), &local_size) == 0 &&
         ::getpeername(socket, reinterpret_cast<sockaddr*>(&peer), &peer_size) == 0 &&
         local_size == peer_size && std::memcmp(&local, &peer, local_size) == 0;
}

}  // namespace

ModbusTcpLink::ModbusTcpLink(const TcpAddress& address)
    : settings_(address), address_size_(parse_address(address.host, address.port, address_.data())) {}

ModbusTcpLink::~ModbusTcpLink() {
  if (socket_ >= 0) ::close(socket_);
}

void ModbusTcpLink::close() noexcept {
  if (socket_ >= 0) ::close(socket_);
  socket_ = -1;
}

BusStatus ModbusTcpLink::fail(BusStatus status, const char* what, const char* why) noexcept {
  std::snprintf(detail_.data(), detail_.size(), "%s: %s", what, why);
  close();
  return status;
}

BusStatus ModbusTcpLink::open(Nanoseconds deadline) noexcept {
  close();
  if (const BusStatus status = start_connecting(); status != BusStatus::ok) return status;
  return finish_connecting(deadline);
}

BusStatus ModbusTcpLink::start_connecting() noexcept {
  if (address_size_ == 0) return fail(BusStatus::disconnected, "connecting", "not a numeric address");
  sockaddr family{};
  std::memcpy(&family, address_.data(), sizeof family);
  socket_ = ::socket(family.sa_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (socket_ < 0) return fail(BusStatus::disconnected, "opening a socket", text_of_errno(errno));
  set_option(socket_, IPPROTO_TCP, TCP_NODELAY, 1);
  set_option(socket_, SOL_SOCKET, SO_KEEPALIVE, 1);
  set_option(socket_, IPPROTO_TCP, TCP_KEEPIDLE, keepalive_idle_s);
  set_option(socket_, IPPROTO_TCP, TCP_KEEPINTVL, keepalive_interval_s);
  set_option(socket_, IPPROTO_TCP, TCP_KEEPCNT, keepalive_probes);
  set_option(socket_, IPPROTO_TCP, TCP_USER_TIMEOUT, user_timeout_ms);
  const auto* address = reinterpret_cast<const sockaddr*>(address_.data());
  if (::connect(socket_, address, address_size_) == 0 || errno == EINPROGRESS) return BusStatus::ok;
  return fail(BusStatus::disconnected, "connecting", text_of_errno(errno));
}

BusStatus ModbusTcpLink::finish_connecting(Nanoseconds deadline) noexcept {
  if (const BusStatus status = wait_until_ready(POLLOUT, deadline, "connecting"); status != BusStatus::ok) {
    return status;
  }
  int error = 0;
  socklen_t size = sizeof error;
  if (::getsockopt(socket_, SOL_SOCKET, SO_ERROR, &error, &size) != 0) error = errno;
  if (error != 0) return fail(BusStatus::disconnected, "connecting", text_of_errno(error));
  if (talks_to_itself(socket_)) {
    return fail(BusStatus::disconnected, "connecting", text_of_errno(ECONNREFUSED));
  }
  return BusStatus::ok;
}

BusStatus ModbusTcpLink::wait_until_ready(short events, Nanoseconds deadline, const char* what) noexcept {
  switch (wait_for(socket_, events, deadline)) {
    case Waited::ready:
      return BusStatus::ok;
    case Waited::timed_out:
      return fail(BusStatus::timed_out, what, "the deadline passed");
    case Waited::failed:
      break;
  }
  return fail(BusStatus::disconnected, what, text_of_errno(errno));
}

BusStatus ModbusTcpLink::send_all(std::span<const std::uint8_t> frame, Nanoseconds deadline) noexcept {
  while (!frame.empty()) {
    const ssize_t sent = ::send(socket_, frame.data(), frame.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent >= 0) {
      frame = frame.subspan(static_cast<std::size_t>(sent));
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      if (const BusStatus status = wait_until_ready(POLLOUT, deadline, "sending"); status != BusStatus::ok) {
        return status;
      }
    } else if (errno != EINTR) {
      return fail(BusStatus::disconnected, "sending", text_of_errno(errno));
    }
  }
  return BusStatus::ok;
}

BusStatus ModbusTcpLink::receive(std::uint8_t unit, const ModbusRequest& request,
                                 Nanoseconds deadline) noexcept {
  std::size_t have = 0;
  while (true) {
    if (const BusStatus status = wait_until_ready(
            POLLIN, deadline, have == 0 ? "waiting for the reply" : "waiting for the rest of the reply");
        status != BusStatus::ok) {
      return status;
    }
    const ssize_t got = ::recv(socket_, incoming_.data() + have, incoming_.size() - have, MSG_DONTWAIT);
    if (got == 0)
      return fail(BusStatus::disconnected, "waiting for the reply", "the board closed the session");
    if (got < 0) {
      if (errno == EINTR || errno == EAGAIN || errno == EWOULDBLOCK) continue;
      return fail(BusStatus::disconnected, "waiting for the reply", text_of_errno(errno));
    }
    have += static_cast<std::size_t>(got);
    const ModbusReply reply =
        parse_reply(std::span<const std::uint8_t>(incoming_).first(have), request, transaction_, unit);
    switch (reply.state) {
      case ModbusReply::State::incomplete:
        break;
      case ModbusReply::State::complete:
        data_ = reply.data;
        return BusStatus::ok;
      case ModbusReply::State::exception:
        std::snprintf(detail_.data(), detail_.size(),
                      "the board refused function %u at %u: %s (exception %u)",
                      static_cast<unsigned>(request.function), static_cast<unsigned>(request.address),
                      text_of_exception(reply.exception_code), static_cast<unsigned>(reply.exception_code));
        return BusStatus::exception;
      case ModbusReply::State::defective:
        return fail(BusStatus::bad_reply, "receiving", text_of(reply.defect));
    }
  }
}

BusStatus ModbusTcpLink::ask(std::uint8_t unit, const ModbusRequest& request, Nanoseconds deadline) noexcept {
  data_ = {};
  if (!is_open()) return BusStatus::disconnected;
  ++transaction_;
  const std::size_t size = build_request(request, transaction_, unit, outgoing_);
  if (size == 0) return fail(BusStatus::bad_reply, "asking", "no such Modbus request");
  const auto frame = std::span<const std::uint8_t>(outgoing_).first(size);
  const MonotonicClock clock;
  const Nanoseconds asked_at = clock.now();
  if (const BusStatus status = send_all(frame, deadline); status != BusStatus::ok) return status;
  const BusStatus status = receive(unit, request, deadline);
  last_round_trip_ = clock.now() - asked_at;
  return status;
}

Board::Budget ModbusTcpLink::cost(std::span<const TransactionSize> transactions,
                                  const std::string& plan) const {
  return tcp_cost(transactions.size(), plan, settings_.host, round_trips_);
}

std::string ModbusTcpLink::describe() const {
  return settings_.host + ":" + std::to_string(settings_.port);
}

}  // namespace softgrip::drivers
