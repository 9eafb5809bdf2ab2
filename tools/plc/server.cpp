#include "tools/plc/server.h"

#include <netdb.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

namespace softgrip::plc {
namespace {

/// Largest number of refused addresses that are printed.
constexpr std::size_t most_refused = 100;

}  // namespace

std::string address_of(int socket) {
  sockaddr_storage peer{};
  socklen_t size = sizeof peer;
  std::array<char, NI_MAXHOST> host{};
  if (::getpeername(socket, reinterpret_cast<sockaddr*>(&peer), &size) != 0 ||
      ::getnameinfo(reinterpret_cast<const sockaddr*>(&peer), size, host.data(), host.size(), nullptr, 0,
                    NI_NUMERICHOST) != 0) {
    return {};
  }
  return net::normal_address(host.data());
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
    for (Session& session : sessions_)
      session.poll_entry = polled.add(session.connection.descriptor(), true, session.connection.blocked());
    const auto outcome = polled.wait(Gateway::max_update_period);
    if (outcome == net::PollSet::Outcome::too_many_descriptors && close_newest_session()) continue;
    if (outcome != net::PollSet::Outcome::done || polled[signal]) return;
    const Nanoseconds now = clock_.now();
    if (daemon_.connect(now)) gateway_.on_daemon_connected(now);
    const auto take = [&](const nlohmann::ordered_json& line) { gateway_.on_daemon_line(line, now); };
    if (daemon_ && !daemon_.receive_lines(take)) gateway_.on_daemon_disconnected();
    gateway_.update(now);
    for (Session& session : sessions_) {
      if (!serve(session, polled[session.poll_entry], now)) gateway_.connections().remove(session.id);
    }
    if (polled[listener]) accept(now);
    std::erase_if(sessions_, [&](const Session& session) { return !gateway_.connections().has(session.id); });
    if (!daemon_) continue;
    for (const auto& line : gateway_.take_lines_to_daemon()) daemon_.send(line);
  }
}

/// Closes the newest connection. Must be called if poll() fails because it would watch more descriptors than
/// the process may have.
bool Server::close_newest_session() {
  if (sessions_.empty()) return false;
  gateway_.connections().remove(sessions_.back().id);
  sessions_.pop_back();
  return true;
}

void Server::accept(Nanoseconds now) {
  Descriptor socket = acceptor_.accept(now);
  if (!socket) return;
  const std::string address = address_of(socket.get());
  const std::vector<std::string>& allow = settings_.allow;
  if (std::find(allow.begin(), allow.end(), address) == allow.end()) {
    if (refused_.size() < most_refused && refused_.insert(address).second)
      std::fprintf(stderr, "refused a connection from %s: the address is not listed in `allow`\n",
                   address.c_str());
    return;
  }
  if (const auto id = gateway_.connections().admit(address, now))
    sessions_.push_back({*id, modbus::Connection(std::move(socket))});
}

bool Server::serve(Session& session, net::PollSet::Events events, Nanoseconds now) {
  ClientConnection* const client = gateway_.connections().find(session.id);
  if (client == nullptr) return false;
  bool open = true;
  if (events.input() || events.hangup_or_error()) {
    bool served = false;
    open = session.connection.receive([&](const modbus::Request& request) {
      served = true;
      return gateway_.serve(session.id, request, now);
    });
    client->partial_request = session.connection.half();
    if (served && !client->partial_request) gateway_.on_requests_served(session.id);
  }
  return open && session.connection.send_due(modbus::Clock::now());
}

}  // namespace softgrip::plc
