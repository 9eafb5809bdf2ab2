#include "tools/plc/server.h"

#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <string_view>
#include <utility>
#include <vector>

#include "base/net/listener.h"
#include "base/periodic_schedule.h"

namespace softgrip::plc {

std::string address_of(int socket) {
  sockaddr_storage peer{};
  socklen_t size = sizeof peer;
  std::array<char, NI_MAXHOST> host{};
  if (::getpeername(socket, reinterpret_cast<sockaddr*>(&peer), &size) != 0 ||
      ::getnameinfo(reinterpret_cast<const sockaddr*>(&peer), size, host.data(), host.size(), nullptr, 0,
                    NI_NUMERICHOST) != 0) {
    return {};
  }
  std::string_view name(host.data());
  constexpr std::string_view four_in_six = "::ffff:";
  if (name.starts_with(four_in_six)) name.remove_prefix(four_in_six.size());
  return std::string(name);
}

Server::Server(const Settings& settings, Gateway& gateway, Descriptor listener, Descriptor signals)
    : settings_(settings),
      gateway_(gateway),
      daemon_(settings.socket, gateway),
      entrance_(std::move(listener)),
      signals_(std::move(signals)) {}

void Server::run() {
  std::vector<pollfd> watched;
  constexpr std::size_t others = 3;
  const timespec pause{0, Gateway::longest_pause};
  for (;;) {
    watched.assign({{signals_.get(), POLLIN, 0},
                    {entrance_.descriptor(clock_.now()), POLLIN, 0},
                    {daemon_.descriptor(), POLLIN, 0}});
    for (const Line& line : lines_) {
      const int events = line.connection.blocked() ? POLLIN | POLLOUT : POLLIN;
      watched.push_back({line.connection.descriptor(), static_cast<short>(events), 0});
    }
    if (::ppoll(watched.data(), watched.size(), &pause, nullptr) < 0 && errno != EINTR) {
      if (errno == EINVAL && give_up_line()) continue;
      return;
    }
    if (watched[0].revents != 0) return;
    const Nanoseconds now = clock_.now();
    daemon_.receive(now);
    gateway_.look_after(now);
    auto watch = watched.begin() + others;
    for (Line& line : lines_) {
      if (!serve(line, (watch++)->revents, now)) gateway_.masters().leave(line.master);
    }
    if (watched[1].revents != 0) accept(now);
    std::erase_if(lines_, [&](const Line& line) { return !gateway_.masters().has(line.master); });
    daemon_.send();
  }
}

/// Closes the newest connection. Call this function if poll() fails because it would watch more descriptors
/// than the process may have.
bool Server::give_up_line() {
  if (lines_.empty()) return false;
  gateway_.masters().leave(lines_.back().master);
  lines_.pop_back();
  return true;
}

void Server::accept(Nanoseconds now) {
  Descriptor socket = entrance_.accept(now);
  if (!socket) return;
  const std::string address = address_of(socket.get());
  const std::vector<std::string>& allow = settings_.allow;
  if (std::find(allow.begin(), allow.end(), address) == allow.end()) return;
  if (const auto master = gateway_.masters().admit(address, now))
    lines_.push_back({*master, modbus::Connection(std::move(socket))});
}

bool Server::serve(Line& line, short events, Nanoseconds now) {
  Master* const master = gateway_.masters().find(line.master);
  if (master == nullptr) return false;
  bool open = true;
  if ((events & (POLLIN | POLLHUP | POLLERR)) != 0) {
    open = line.connection.receive(
        [&](const modbus::Request& request) { return gateway_.serve(line.master, request, now); });
    master->half = line.connection.half();
  }
  return open && line.connection.send_due(modbus::Clock::now());
}

}  // namespace softgrip::plc
