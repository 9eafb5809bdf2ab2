#include "tools/plc/server.h"

#include <netdb.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

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
      daemon_(settings.socket),
      acceptor_(std::move(listener)),
      signals_(std::move(signals)) {}

void Server::run() {
  net::PollSet polled;
  for (;; polled.clear()) {
    const auto signal = polled.add(signals_.get());
    const auto listener = polled.add(acceptor_.descriptor(clock_.now()));
    polled.add(daemon_.descriptor());
    for (Line& line : lines_)
      line.poll_entry = polled.add(line.connection.descriptor(), true, line.connection.blocked());
    const auto outcome = polled.wait(Gateway::longest_pause);
    if (outcome == net::PollSet::Outcome::too_many_descriptors && give_up_line()) continue;
    if (outcome != net::PollSet::Outcome::done || polled[signal]) return;
    const Nanoseconds now = clock_.now();
    if (daemon_.connect(now)) gateway_.daemon_came(now);
    const auto take = [&](const nlohmann::ordered_json& line) { gateway_.daemon_said(line, now); };
    if (daemon_ && !daemon_.hear(take)) gateway_.daemon_went();
    gateway_.look_after(now);
    for (Line& line : lines_) {
      if (!serve(line, polled[line.poll_entry], now)) gateway_.masters().leave(line.master);
    }
    if (polled[listener]) accept(now);
    std::erase_if(lines_, [&](const Line& line) { return !gateway_.masters().has(line.master); });
    if (!daemon_) continue;
    for (const auto& line : gateway_.lines_to_daemon()) daemon_.send(line);
  }
}

/// Closes the newest connection. Must be called if poll() fails because it would watch more descriptors than
/// the process may have.
bool Server::give_up_line() {
  if (lines_.empty()) return false;
  gateway_.masters().leave(lines_.back().master);
  lines_.pop_back();
  return true;
}

void Server::accept(Nanoseconds now) {
  Descriptor socket = acceptor_.accept(now);
  if (!socket) return;
  const std::string address = address_of(socket.get());
  const std::vector<std::string>& allow = settings_.allow;
  if (std::find(allow.begin(), allow.end(), address) == allow.end()) return;
  if (const auto master = gateway_.masters().admit(address, now))
    lines_.push_back({*master, modbus::Connection(std::move(socket))});
}

bool Server::serve(Line& line, net::PollSet::Events events, Nanoseconds now) {
  Master* const master = gateway_.masters().find(line.master);
  if (master == nullptr) return false;
  bool open = true;
  if (events.input() || events.hangup_or_error()) {
    open = line.connection.receive(
        [&](const modbus::Request& request) { return gateway_.serve(line.master, request, now); });
    master->half = line.connection.half();
  }
  return open && line.connection.send_due(modbus::Clock::now());
}

}  // namespace softgrip::plc
