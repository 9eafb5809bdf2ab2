#include "daemon/socket/socket_server.h"

#include <grp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/grid.h"
#include "daemon/socket/socket_api.h"

namespace softgrip::daemon {

namespace {

constexpr int backlog = 128;
/// New clients in one call: they must not keep those that are there from having their turn.
constexpr int most_accepts = 4;
/// A client that has just come keeps its place for so long, though it has not said anything yet; one that has
/// spoken for so long after its last word, or after the last one that it took.
constexpr Nanoseconds first_word = ns_per_s / 10;
constexpr Nanoseconds longest_silence = 5 * ns_per_s;
/// Clients beside those that have places.
constexpr std::size_t most_standing = 32;
/// Lines of one client in one call take no longer than this and one more line.
constexpr std::chrono::microseconds longest_turn(500);
/// Without a descriptor for it a new client cannot even be refused.
constexpr Nanoseconds accept_pause = ns_per_s / 10;
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
  struct stat status {};
  if (lstat(settings.path.c_str(), &status) != 0) return failure(settings.path, "its own file");
  SocketServer server(settings, std::move(listener));
  server.device_ = status.st_dev;
  server.inode_ = status.st_ino;
  return server;
}

SocketServer::SocketServer(SocketServer&& other) noexcept = default;

SocketServer::~SocketServer() {
  struct stat status {};
  // Somebody may have removed it and another daemon have put its own there.
  const bool there = listener_ && lstat(settings_.path.c_str(), &status) == 0;
  if (there && status.st_dev == device_ && status.st_ino == inode_) unlink(settings_.path.c_str());
}

void SocketServer::poll(Nanoseconds now, Nanoseconds until) {
  now_ = now;
  const bool accepts = now >= accepts_again_;
  std::vector<pollfd> polled{{listener_.get(), static_cast<short>(accepts ? POLLIN : 0), 0}};
  std::vector<std::uint64_t> ids{0};
  for (const auto& [id, client] : clients_) {
    // A client whose replies are not taken is not read either, nor one that has more to say than its turn
    // takes.
    const bool writes = !client.output.empty();
    const bool reads = client.ended_at == 0 && !has_line(client);
    polled.push_back({client.socket.get(), static_cast<short>(writes ? POLLOUT : reads ? POLLIN : 0), 0});
    ids.push_back(id);
  }
  const Nanoseconds wait = lines_left_ ? 0 : std::max<Nanoseconds>(until - now, 0);
  const timespec timeout{wait / ns_per_s, wait % ns_per_s};
  if (::ppoll(polled.data(), polled.size(), &timeout, nullptr) > 0) {
    for (std::size_t i = 1; i < polled.size(); ++i) {
      Client& client = clients_.at(ids[i]);
      if ((polled[i].revents & POLLOUT) != 0) write_to(client, now);
      if ((polled[i].revents & POLLIN) != 0) read_from(client);
      if ((polled[i].revents & (POLLERR | POLLNVAL)) != 0) client.dead = true;
      if ((polled[i].revents & POLLHUP) != 0 && (polled[i].revents & POLLIN) == 0) client.dead = true;
    }
    if ((polled[0].revents & POLLIN) != 0) accept_some();
  }
  lines_left_ = false;
  for (auto& [id, client] : clients_) {
    take_lines(id, client);
    lines_left_ = lines_left_ || (!client.dead && client.output.empty() && has_line(client));
  }
  sweep(now);
}

void SocketServer::accept_some() {
  for (int i = 0; i < most_accepts; ++i) {
    Descriptor socket = accept_one();
    if (!socket) return;
    const bool full = clients_.size() >= settings_.max_clients;
    const bool stands = full && !displace_one(false);
    if (clients_.size() >= settings_.max_clients + most_standing) displace_one(true);
    Client& client = clients_[++last_id_];
    client.socket = std::move(socket);
    client.active_at = now_;
    client.stands = stands;
    read_from(client);  // what it has to say is usually there already
  }
}

/// Nothing if nobody waits, or if there is no descriptor even without the longest silent client.
Descriptor SocketServer::accept_one() {
  for (;;) {
    Descriptor socket(accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
    const bool none_left =
        !socket && (errno == EMFILE || errno == ENFILE || errno == ENOBUFS || errno == ENOMEM);
    if (!none_left) return socket;
    if (displace_one(true)) continue;
    accepts_again_ = now_ + accept_pause;
    return socket;
  }
}

/// It has had the time to say something, and has not for long.
bool SocketServer::may_go(const Client& client) const {
  return client.ended_at != 0 || now_ - client.active_at >= (client.spoke ? longest_silence : first_word);
}

/// Of those that may go, or of all if it must be: the one that stands, never spoke, was silent for longest,
/// in this order. False if there is none.
bool SocketServer::displace_one(bool whoever) {
  const auto rank = [](const Client& client) {
    return std::tuple(client.ended_at == 0, !client.stands, client.spoke, client.active_at);
  };
  auto found = clients_.end();
  for (auto entry = clients_.begin(); entry != clients_.end(); ++entry) {
    const Client& client = entry->second;
    if (!whoever && !may_go(client)) continue;
    if (found == clients_.end() || rank(client) < rank(found->second)) found = entry;
  }
  if (found == clients_.end()) return false;
  // Best effort: nobody waits for a client that does not read.
  const std::string line = too_many();
  [[maybe_unused]] const ssize_t sent =
      ::send(found->second.socket.get(), line.data(), line.size(), MSG_NOSIGNAL);
  const std::uint64_t id = found->first;
  clients_.erase(found);
  handlers_.on_closed(id);
  return true;
}

std::string SocketServer::too_many() const {
  return error_line(std::nullopt, "too_many_clients",
                    fmt::format("at most {} clients at a time; stop and vent are heard all the same",
                                settings_.max_clients));
}

void SocketServer::hear(std::uint64_t id, Client& client, std::string_view line) {
  if (!client.stands || (handlers_.is_urgent && handlers_.is_urgent(line))) {
    handlers_.on_line(id, line);
  } else {
    send(id, too_many(), false);
    client.closing = true;
  }
  // One word, and the time until its answer.
  if (client.stands) client.ended_at = now_;
}

void SocketServer::read_from(Client& client) {
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
}

bool SocketServer::has_line(const Client& client) {
  return client.input.find('\n') != std::string::npos;
}

/// As many as its turn allows, and no more as long as an answer waits to be taken.
void SocketServer::take_lines(std::uint64_t id, Client& client) {
  const auto began = std::chrono::steady_clock::now();
  std::size_t begin = 0;
  for (std::size_t end = client.input.find('\n');
       end != std::string::npos && !client.dead && client.output.empty();
       end = client.input.find('\n', begin)) {
    std::string_view line(client.input.data() + begin, end - begin);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (line.size() > settings_.max_line_bytes) break;
    client.active_at = now_;
    client.spoke = true;
    if (!line.empty()) hear(id, client, line);
    begin = client.stands ? client.input.size() : end + 1;
    if (std::chrono::steady_clock::now() - began > longest_turn) break;
  }
  client.input.erase(0, begin);
  // The end of a line that is too long may be there or not.
  if (std::min(client.input.find('\n'), client.input.size()) > settings_.max_line_bytes) {
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
    client.active_at = now;
  }
}

void SocketServer::sweep(Nanoseconds now) {
  for (auto entry = clients_.begin(); entry != clients_.end();) {
    Client& client = entry->second;
    const bool stalled = client.stalled_since != 0 && now - client.stalled_since > longest_stall;
    const bool left = client.ended_at != 0 && now - client.ended_at > answer_pause && !has_line(client);
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
