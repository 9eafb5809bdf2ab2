#include "daemon/socket/socket_server.h"

#include <grp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "base/grid.h"
#include "daemon/socket/socket_api.h"

namespace softgrip::daemon {

namespace {

constexpr int backlog = 16;
/// A client that takes nothing for so long has lost interest.
constexpr Nanoseconds longest_stall = 10 * ns_per_s;
/// How long a client that will send no more may wait for what it asked.
constexpr Nanoseconds answer_pause = 2 * ns_per_s;
/// At most so much is read of one client before the others have their turn.
constexpr std::size_t read_bytes = 16 * 1024;

using Failure = tl::unexpected<std::string>;

Failure failure(const std::string& path, std::string_view what) {
  return Failure(fmt::format("{}: {}: {}", path, what, std::strerror(errno)));
}

/// Nothing if the path is too long for a socket.
std::optional<sockaddr_un> address_of(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) return std::nullopt;
  std::memcpy(address.sun_path, path.data(), path.size());
  return address;
}

/// Whether somebody listens there; if not, errno says why.
bool answers(const sockaddr_un& address) {
  const Descriptor probe(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const auto* generic = reinterpret_cast<const sockaddr*>(&address);
  return connect(probe.get(), generic, sizeof address) == 0 || errno == EAGAIN;
}

/// Removes the file of a daemon that is gone. False if one answers.
bool clear_away(const sockaddr_un& address) {
  if (answers(address)) return false;
  // A file that is no socket refuses a connection, too; it is somebody's, and bind() will say that it is
  // there.
  struct stat status {};
  const bool refused = errno == ECONNREFUSED;
  if (refused && lstat(address.sun_path, &status) == 0 && S_ISSOCK(status.st_mode)) unlink(address.sun_path);
  return true;
}

/// Mode and group of the socket's file.
bool give_rights(const rig::SocketSettings& settings) {
  if (!settings.group.empty()) {
    const group* entry = getgrnam(settings.group.c_str());
    if (entry == nullptr) {
      errno = errno == 0 ? EINVAL : errno;
      return false;
    }
    if (chown(settings.path.c_str(), static_cast<uid_t>(-1), entry->gr_gid) != 0) return false;
  }
  return chmod(settings.path.c_str(), settings.mode) == 0;
}

}  // namespace

bool socket_answers(const std::string& path) {
  const auto address = address_of(path);
  return !path.empty() && address && answers(*address);
}

tl::expected<SocketServer, std::string> SocketServer::listen(const rig::SocketSettings& settings) {
  const auto address = address_of(settings.path);
  if (!address) {
    return Failure(fmt::format("{}: the path of a socket has at most {} bytes", settings.path,
                               sizeof address->sun_path - 1));
  }
  if (!clear_away(*address))
    return Failure(fmt::format("{}: another softgripd answers there", settings.path));
  std::error_code ignored;
  std::filesystem::create_directories(std::filesystem::path(settings.path).parent_path(), ignored);

  Descriptor listener(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!listener) return failure(settings.path, "socket");
  // Between bind and chmod nobody else may connect.
  const mode_t before = umask(0177);
  const int bound = bind(listener.get(), reinterpret_cast<const sockaddr*>(&*address), sizeof *address);
  umask(before);
  if (bound != 0) return failure(settings.path, "bind");
  if (!give_rights(settings)) {
    const auto problem =
        failure(settings.path, fmt::format("mode {:o} group '{}'", settings.mode, settings.group));
    unlink(settings.path.c_str());
    return problem;
  }
  if (::listen(listener.get(), backlog) != 0) return failure(settings.path, "listen");
  return SocketServer(settings, std::move(listener));
}

SocketServer::SocketServer(SocketServer&& other) noexcept = default;

SocketServer::~SocketServer() {
  if (listener_) unlink(settings_.path.c_str());
}

void SocketServer::poll(Nanoseconds now, Nanoseconds until) {
  now_ = now;
  std::vector<pollfd> polled{{listener_.get(), POLLIN, 0}};
  std::vector<std::uint64_t> ids{0};
  for (const auto& [id, client] : clients_) {
    // A client whose replies are not taken is not read either.
    const bool writes = !client.output.empty();
    const auto events = static_cast<short>(writes ? POLLOUT : client.ended_at != 0 ? 0 : POLLIN);
    polled.push_back({client.socket.get(), events, 0});
    ids.push_back(id);
  }
  const Nanoseconds wait = std::max<Nanoseconds>(until - now, 0);
  const timespec timeout{wait / ns_per_s, wait % ns_per_s};
  if (::ppoll(polled.data(), polled.size(), &timeout, nullptr) > 0) {
    for (std::size_t i = 1; i < polled.size(); ++i) {
      Client& client = clients_.at(ids[i]);
      if ((polled[i].revents & POLLOUT) != 0) write_to(client, now);
      if ((polled[i].revents & POLLIN) != 0) read_from(ids[i], client);
      if ((polled[i].revents & (POLLERR | POLLNVAL)) != 0) client.dead = true;
      if ((polled[i].revents & POLLHUP) != 0 && (polled[i].revents & POLLIN) == 0) client.dead = true;
    }
    if ((polled[0].revents & POLLIN) != 0) accept_all();
  }
  sweep(now);
}

void SocketServer::accept_all() {
  for (;;) {
    Descriptor socket(accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
    if (!socket) return;
    if (clients_.size() >= settings_.max_clients) {
      const std::string line = error_line(std::nullopt, "too_many_clients",
                                          fmt::format("at most {} clients at a time", settings_.max_clients));
      // Best effort: the buffer of a new socket takes a line.
      [[maybe_unused]] const ssize_t sent = ::send(socket.get(), line.data(), line.size(), MSG_NOSIGNAL);
      continue;
    }
    clients_[++last_id_].socket = std::move(socket);
  }
}

void SocketServer::read_from(std::uint64_t id, Client& client) {
  if (client.closing) return;
  std::array<char, read_bytes> buffer;
  const ssize_t count = recv(client.socket.get(), buffer.data(), buffer.size(), 0);
  if (count < 0) {
    client.dead = errno != EAGAIN && errno != EINTR;
    return;
  }
  if (count == 0) {
    // `echo ... | socat` says no more, but waits for the answer.
    client.ended_at = now_;
    return;
  }
  client.input.append(buffer.data(), static_cast<std::size_t>(count));
  take_lines(id, client);
}

void SocketServer::take_lines(std::uint64_t id, Client& client) {
  std::size_t begin = 0;
  for (std::size_t end = client.input.find('\n'); end != std::string::npos && !client.dead;
       end = client.input.find('\n', begin)) {
    std::string_view line(client.input.data() + begin, end - begin);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (line.size() > settings_.max_line_bytes) break;
    if (!line.empty()) handlers_.on_line(id, line);
    begin = end + 1;
  }
  client.input.erase(0, begin);
  if (client.input.size() > settings_.max_line_bytes) {
    send(id,
         error_line(std::nullopt, "too_long",
                    fmt::format("a line has at most {} bytes", settings_.max_line_bytes)),
         false);
    client.input.clear();
    client.closing = true;
  }
}

void SocketServer::send(std::uint64_t id, std::string_view line, bool skippable) {
  const auto found = clients_.find(id);
  if (found == clients_.end()) return;
  Client& client = found->second;
  if (client.dead || client.closing || (skippable && !client.output.empty())) return;
  if (client.output.size() + line.size() > settings_.max_queue_bytes) {
    client.dead = true;
    return;
  }
  client.output += line;
  write_to(client, now_);
}

void SocketServer::write_to(Client& client, Nanoseconds now) {
  while (!client.output.empty()) {
    const ssize_t count =
        ::send(client.socket.get(), client.output.data(), client.output.size(), MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && errno == EAGAIN) {
      if (client.stalled_since == 0) client.stalled_since = now;
      return;
    }
    if (count < 0) {
      client.dead = true;
      return;
    }
    client.output.erase(0, static_cast<std::size_t>(count));
    client.stalled_since = 0;
  }
}

void SocketServer::sweep(Nanoseconds now) {
  for (auto entry = clients_.begin(); entry != clients_.end();) {
    Client& client = entry->second;
    const bool stalled = client.stalled_since != 0 && now - client.stalled_since > longest_stall;
    const bool left = client.ended_at != 0 && now - client.ended_at > answer_pause;
    const bool done = (client.closing || left) && client.output.empty();
    if (!client.dead && !stalled && !done) {
      ++entry;
      continue;
    }
    const std::uint64_t id = entry->first;
    entry = clients_.erase(entry);
    handlers_.on_closed(id);
  }
}

}  // namespace softgrip::daemon
