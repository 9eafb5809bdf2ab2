#include "drivers/modbus_session.h"

#include <arpa/inet.h>
#include <modbus/modbus.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ctime>

#include "drivers/clock.h"

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

/// Text of an errno, from a table in the C library.
const char* text_of_errno(int error) noexcept {
  const char* text = ::strerrordesc_np(error);
  return text != nullptr ? text : "unknown error";
}

/// Text of a Modbus exception. For a code it does not know libmodbus asks strerror, which allocates.
const char* text_of_exception(unsigned code) noexcept {
  const bool known = code >= MODBUS_EXCEPTION_ILLEGAL_FUNCTION && code < MODBUS_EXCEPTION_MAX &&
                     code != MODBUS_EXCEPTION_NOT_DEFINED;
  return known ? ::modbus_strerror(MODBUS_ENOBASE + static_cast<int>(code)) : "no exception of the standard";
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

ModbusSession::ModbusSession(const std::string& host, std::uint16_t port, std::uint8_t unit)
    : address_size_(parse_address(host, port, address_.data())), unit_(unit) {}

ModbusSession::~ModbusSession() {
  close();
}

void ModbusSession::close() noexcept {
  if (socket_ >= 0) ::close(socket_);
  socket_ = -1;
}

BusStatus ModbusSession::fail(BusStatus status, const char* what, const char* why) noexcept {
  std::snprintf(detail_.data(), detail_.size(), "%s: %s", what, why);
  close();
  return status;
}

BusStatus ModbusSession::open(Nanoseconds deadline) noexcept {
  close();
  if (const BusStatus status = start_connecting(); status != BusStatus::ok) return status;
  return finish_connecting(deadline);
}

BusStatus ModbusSession::start_connecting() noexcept {
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

BusStatus ModbusSession::finish_connecting(Nanoseconds deadline) noexcept {
  if (const BusStatus status = wait_for(POLLOUT, deadline, "connecting"); status != BusStatus::ok) {
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

BusStatus ModbusSession::wait_for(short events, Nanoseconds deadline, const char* what) noexcept {
  const MonotonicClock clock;
  while (true) {
    const Nanoseconds remaining = deadline - clock.now();
    if (remaining <= 0) return fail(BusStatus::timed_out, what, "the deadline passed");
    const timespec timeout{.tv_sec = remaining / 1'000'000'000, .tv_nsec = remaining % 1'000'000'000};
    pollfd waiting{.fd = socket_, .events = events, .revents = 0};
    // poll, not select: descriptors of 1024 and above are as good as any other.
    const int ready = ::ppoll(&waiting, 1, &timeout, nullptr);
    // Errors and hang-ups count as ready: the call that follows says which.
    if (ready > 0) return BusStatus::ok;
    if (ready < 0 && errno != EINTR) return fail(BusStatus::disconnected, what, text_of_errno(errno));
  }
}

BusStatus ModbusSession::send_all(std::span<const std::uint8_t> frame, Nanoseconds deadline) noexcept {
  while (!frame.empty()) {
    const ssize_t sent = ::send(socket_, frame.data(), frame.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent >= 0) {
      frame = frame.subspan(static_cast<std::size_t>(sent));
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      if (const BusStatus status = wait_for(POLLOUT, deadline, "sending"); status != BusStatus::ok) {
        return status;
      }
    } else if (errno != EINTR) {
      return fail(BusStatus::disconnected, "sending", text_of_errno(errno));
    }
  }
  return BusStatus::ok;
}

BusStatus ModbusSession::receive(const ModbusRequest& request, Nanoseconds deadline) noexcept {
  std::size_t have = 0;
  while (true) {
    if (const BusStatus status = wait_for(
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
        parse_reply(std::span<const std::uint8_t>(incoming_).first(have), request, transaction_, unit_);
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

BusStatus ModbusSession::ask(const ModbusRequest& request, Nanoseconds deadline) noexcept {
  data_ = {};
  if (!is_open()) return BusStatus::disconnected;
  ++transaction_;
  const std::size_t size = build_request(request, transaction_, unit_, outgoing_);
  if (size == 0) return fail(BusStatus::bad_reply, "asking", "no such Modbus request");
  const auto frame = std::span<const std::uint8_t>(outgoing_).first(size);
  if (const BusStatus status = send_all(frame, deadline); status != BusStatus::ok) return status;
  return receive(request, deadline);
}

}  // namespace softgrip::drivers
