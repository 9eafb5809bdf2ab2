#include "tests/drivers/modbus/scripted_server.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <stdexcept>

namespace softgrip::drivers::test {

void Peer::send(const Bytes& bytes) {
  std::size_t sent = 0;
  while (open_ && sent < bytes.size()) {
    const ssize_t n = ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (n <= 0) {
      open_ = false;
      return;
    }
    sent += static_cast<std::size_t>(n);
  }
}

void Peer::drip(const Bytes& bytes, std::chrono::milliseconds pause) {
  for (const std::uint8_t byte : bytes) {
    if (!open_ || server_.stopping_) return;
    send({byte});
    wait(pause);
  }
}

void Peer::wait(std::chrono::milliseconds duration) {
  std::unique_lock lock(server_.mutex_);
  server_.stop_.wait_for(lock, duration, [this] { return server_.stopping_.load(); });
}

void Peer::hang_up() {
  ::shutdown(socket_, SHUT_RDWR);
  open_ = false;
}

void Peer::reset() {
  const linger at_once{1, 0};
  ::setsockopt(socket_, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
  open_ = false;
}

ScriptedServer::ScriptedServer(Handler handler) : handler_(std::move(handler)) {
  listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  if (listener_ < 0 || ::bind(listener_, reinterpret_cast<sockaddr*>(&address), size) != 0 ||
      ::listen(listener_, 16) != 0 ||
      ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    throw std::runtime_error("the scripted server cannot listen");
  }
  port_ = ntohs(address.sin_port);
  thread_ = std::thread([this] { serve(); });
}

ScriptedServer::~ScriptedServer() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  stop_.notify_all();
  thread_.join();
  ::close(listener_);
}

bool ScriptedServer::wait_readable(int socket) {
  while (!stopping_) {
    pollfd waiting{socket, POLLIN, 0};
    if (::poll(&waiting, 1, 10) > 0) return true;
  }
  return false;
}

void ScriptedServer::serve() {
  while (wait_readable(listener_)) {
    const int socket = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    if (socket < 0) continue;
    const int on = 1;
    ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    ++sessions_;
    serve_session(socket);
    ::close(socket);
  }
}

bool ScriptedServer::read_exactly(int socket, std::span<std::uint8_t> bytes) {
  while (!bytes.empty()) {
    if (!wait_readable(socket)) return false;
    const ssize_t n = ::recv(socket, bytes.data(), bytes.size(), 0);
    if (n <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
  return true;
}

void ScriptedServer::serve_session(int socket) {
  Peer peer(socket, *this);
  while (peer.is_open()) {
    Bytes request(6);
    if (!read_exactly(socket, request)) return;
    request.resize(6U + word(request, 4));
    if (!read_exactly(socket, std::span(request).subspan(6))) return;
    handler_(peer, request, requests_++);
  }
}

std::uint16_t word(const Bytes& bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes.at(at) << 8 | bytes.at(at + 1));
}

void set_word(Bytes& bytes, std::size_t at, std::uint16_t value) {
  bytes.at(at) = static_cast<std::uint8_t>(value >> 8);
  bytes.at(at + 1) = static_cast<std::uint8_t>(value & 0xff);
}

Bytes frame_for(const Bytes& request, const Bytes& pdu) {
  Bytes frame{request.at(0), request.at(1), 0, 0, 0, 0, request.at(6)};
  set_word(frame, 4, static_cast<std::uint16_t>(1 + pdu.size()));
  frame.insert(frame.end(), pdu.begin(), pdu.end());
  return frame;
}

Bytes registers_reply(const Bytes& request, const std::function<std::uint16_t(std::uint16_t)>& value_of) {
  const std::uint16_t address = word(request, 8);
  const std::uint16_t count = word(request, 10);
  Bytes pdu(2U + 2U * count);
  pdu[0] = request.at(7);
  pdu[1] = static_cast<std::uint8_t>(2 * count);
  for (std::uint16_t i = 0; i < count; ++i) {
    set_word(pdu, 2U + 2U * i, value_of(static_cast<std::uint16_t>(address + i)));
  }
  return frame_for(request, pdu);
}

Bytes exception_reply(const Bytes& request, std::uint8_t code) {
  return frame_for(request, {static_cast<std::uint8_t>(request.at(7) | 0x80), code});
}

}  // namespace softgrip::drivers::test
