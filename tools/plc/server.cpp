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

#include "base/grid.h"
#include "drivers/modbus_server/listener.h"

namespace softgrip::plc {

bool is_allowed(int socket, const std::vector<std::string>& allow) {
  sockaddr_storage peer{};
  socklen_t size = sizeof peer;
  std::array<char, NI_MAXHOST> host{};
  if (::getpeername(socket, reinterpret_cast<sockaddr*>(&peer), &size) != 0 ||
      ::getnameinfo(reinterpret_cast<const sockaddr*>(&peer), size, host.data(), host.size(), nullptr, 0,
                    NI_NUMERICHOST) != 0) {
    return false;
  }
  std::string_view name(host.data());
  constexpr std::string_view four_in_six = "::ffff:";
  if (name.starts_with(four_in_six)) name.remove_prefix(four_in_six.size());
  return std::find(allow.begin(), allow.end(), name) != allow.end();
}

Server::Server(const Settings& settings, Gateway& gateway, Descriptor listener, Descriptor signals)
    : settings_(settings),
      gateway_(gateway),
      daemon_(settings.socket, gateway),
      listener_(std::move(listener)),
      signals_(std::move(signals)) {}

void Server::run() {
  std::vector<pollfd> watched;
  constexpr std::size_t others = 3;
  const timespec pause{0, Gateway::longest_pause};
  for (;;) {
    watched.assign(
        {{signals_.get(), POLLIN, 0}, {listener_.get(), POLLIN, 0}, {daemon_.descriptor(), POLLIN, 0}});
    for (const Master& master : masters_) {
      const int events = master.connection.blocked() ? POLLIN | POLLOUT : POLLIN;
      watched.push_back({master.connection.descriptor(), static_cast<short>(events), 0});
    }
    if (::ppoll(watched.data(), watched.size(), &pause, nullptr) < 0 && errno != EINTR) return;
    if (watched[0].revents != 0) return;
    const Nanoseconds now = clock_.now();
    daemon_.receive(now);
    gateway_.look_after(now);
    auto watch = watched.begin() + others;
    std::erase_if(masters_, [&](Master& master) { return !serve(master, (watch++)->revents, now); });
    if (watched[1].revents != 0) accept(now);
    daemon_.send();
  }
}

void Server::accept(Nanoseconds now) {
  Descriptor socket = modbus::accept_client(listener_);
  if (!socket || !is_allowed(socket.get(), settings_.allow)) return;
  if (masters_.size() >= settings_.max_masters) return;
  masters_.push_back({modbus::Connection(std::move(socket)), now});
}

bool Server::serve(Master& master, short events, Nanoseconds now) {
  bool open = now - master.asked_at < nanoseconds(settings_.idle_s);
  if ((events & (POLLIN | POLLHUP | POLLERR)) != 0) {
    open = master.connection.receive([&](const modbus::Request& request) {
      master.asked_at = now;
      return gateway_.serve(request, now);
    });
  }
  return open && master.connection.send_due(modbus::Clock::now());
}

}  // namespace softgrip::plc
