#include "tools/rig/server.h"

#include <poll.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <vector>

#include "tools/rig/control.h"
#include "tools/rig/listener.h"

namespace softgrip::tools::rig {
namespace {

constexpr std::size_t max_modbus_clients = 32;
constexpr std::size_t max_control_clients = 8;
constexpr std::size_t max_control_line = 1024;
// Nothing waits longer for the truth log and for faults that begin by the clock.
constexpr std::chrono::milliseconds longest_wait{20};

}  // namespace

int Server::ControlClient::input() const noexcept {
  return socket ? socket.get() : STDIN_FILENO;
}

Server::Server(Emulator& emulator, ServerSockets sockets)
    : emulator_(emulator), sockets_(std::move(sockets)) {
  if (sockets_.standard_input) control_clients_.emplace_back();
}

void Server::run(const std::function<void()>& idle) {
  std::vector<pollfd> watched;
  while (!quit_) {
    watched.clear();
    watched.push_back({sockets_.signals.get(), POLLIN, 0});
    watched.push_back({sockets_.modbus.get(), POLLIN, 0});
    watched.push_back({sockets_.control.get(), POLLIN, 0});  // poll() skips an empty one: it is -1
    for (const ControlClient& client : control_clients_) watched.push_back({client.input(), POLLIN, 0});
    for (const Connection& connection : connections_) {
      const int events = connection.blocked() ? POLLIN | POLLOUT : POLLIN;
      watched.push_back({connection.descriptor(), static_cast<short>(events), 0});
    }
    if (::poll(watched.data(), watched.size(), timeout_ms()) < 0 && errno != EINTR) return;

    emulator_.advance(now());
    auto watch = watched.begin() + 3;
    for (ControlClient& client : control_clients_) {
      if ((watch++)->revents != 0) read_control(client);
    }
    std::erase_if(control_clients_, [](const ControlClient& client) { return !client.open; });
    std::erase_if(connections_, [&](Connection& connection) {
      bool open = true;
      serve(connection, (watch++)->revents, open);
      return !open;
    });
    if (watched[0].revents != 0) take_signal();
    if (watched[1].revents != 0) accept_modbus();
    if (watched[2].revents != 0) accept_control();
    idle();
  }
}

model::Nanoseconds Server::now() const {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start_).count();
}

int Server::timeout_ms() const {
  const Clock::time_point now = Clock::now();
  Clock::time_point wake = now + longest_wait;
  for (const Connection& connection : connections_) {
    if (const auto due = connection.next_due(); due && !connection.blocked()) wake = std::min(wake, *due);
  }
  return static_cast<int>(
      std::max<std::int64_t>(0, std::chrono::ceil<std::chrono::milliseconds>(wake - now).count()));
}

void Server::serve(Connection& connection, short events, bool& open) {
  if ((events & (POLLIN | POLLHUP | POLLERR)) != 0) {
    open = connection.receive([this](const Request& request) { return emulator_.serve(now(), request); });
  }
  open = open && connection.send_due(Clock::now()) && emulator_.reachable();
}

void Server::accept_modbus() {
  Descriptor client = accept_client(sockets_.modbus);
  // While the cable is cut, and beyond what poll() should watch, a client is let in and shown out.
  if (client && emulator_.reachable() && connections_.size() < max_modbus_clients) {
    connections_.emplace_back(std::move(client));
  }
}

void Server::accept_control() {
  Descriptor client = accept_client(sockets_.control);
  if (client && control_clients_.size() < max_control_clients) {
    control_clients_.push_back({std::move(client), {}, true});
  }
}

void Server::take_signal() {
  signalfd_siginfo info{};
  if (::read(sockets_.signals.get(), &info, sizeof info) != static_cast<ssize_t>(sizeof info)) return;
  if (info.ssi_signo == SIGUSR1) {
    emulator_.trigger(Emulator::object_out, now());
  } else {
    quit_ = true;
  }
}

void Server::read_control(ControlClient& client) {
  std::array<char, 512> buffer;
  const ssize_t count = ::read(client.input(), buffer.data(), buffer.size());
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return;
  if (count <= 0) {
    client.open = false;
    return;
  }
  client.pending.append(buffer.data(), static_cast<std::size_t>(count));
  std::size_t end = 0;
  while ((end = client.pending.find('\n')) != std::string::npos) {
    answer_control(client, std::string_view(client.pending).substr(0, end));
    client.pending.erase(0, end + 1);
  }
  if (client.pending.size() > max_control_line) client.open = false;
}

void Server::answer_control(const ControlClient& client, std::string_view line) {
  const ControlAnswer answer = control(emulator_, now(), line);
  quit_ = quit_ || answer.quit;
  const std::string text = answer.line + "\n";
  // An answer is shorter than a socket's buffer; one who does not read loses it.
  if (client.socket) {
    ::send(client.socket.get(), text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  } else if (::write(STDOUT_FILENO, text.data(), text.size()) < 0) {
    quit_ = errno == EPIPE;
  }
}

}  // namespace softgrip::tools::rig
