#include "daemon/service/trusted_user.h"

#include <grp.h>
#include <poll.h>
#include <pwd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/clock.h"
#include "base/descriptor.h"
#include "base/net/line_buffer.h"
#include "daemon/socket/listener.h"

namespace softgrip::daemon {
namespace {

constexpr std::size_t most_groups = 65536;  // largest number of groups of a user (NGROUPS_MAX of Linux)

std::optional<gid_t> service_group() {
  const group* const entry = ::getgrnam(service_account);
  return entry != nullptr ? std::optional(entry->gr_gid) : std::nullopt;
}

/// Returns the supplementary groups of the process at the other end of a socket; empty if the kernel does not
/// report them.
std::vector<gid_t> groups_of(int socket) {
  std::vector<gid_t> groups(64);
  for (;;) {
    auto size = static_cast<socklen_t>(groups.size() * sizeof(gid_t));
    if (::getsockopt(socket, SOL_SOCKET, SO_PEERGROUPS, groups.data(), &size) == 0) {
      groups.resize(size / sizeof(gid_t));
      return groups;
    }
    if (groups.size() >= most_groups) return {};
    groups.resize(most_groups);
  }
}

bool in_service_group(int socket, gid_t group) {
  const std::optional<gid_t> wanted = service_group();
  if (!wanted) return false;
  const std::vector<gid_t> groups = groups_of(socket);
  return group == *wanted || std::find(groups.begin(), groups.end(), *wanted) != groups.end();
}

/// Longest time from a request to the reply: one turn of the thread that serves clients (service_patience in
/// real_run.cpp) [ns].
constexpr Nanoseconds answer_patience = 2 * ns_per_s;
constexpr std::size_t longest_reply = std::size_t{8} << 20U;
constexpr std::string_view question = "{\"command\": \"status\"}\n";

/// Returns the first line that arrives before `deadline`. If the line is incomplete at the deadline, returns
/// the part that has arrived.
std::string line_from(int socket, Nanoseconds deadline) {
  net::LineBuffer lines;
  while (!lines.has_line() && !lines.exceeds(longest_reply - 1)) {
    if (wait_for(socket, POLLIN, deadline) != Waited::ready) break;
    if (lines.receive(socket) == net::LineBuffer::Received::end) break;
  }
  lines.append("\n");  // adds a line end, so that the incomplete line is returned
  return std::string(lines.next().value_or(""));
}

}  // namespace

std::optional<uid_t> service_user() {
  const passwd* const entry = ::getpwnam(service_account);
  return entry != nullptr ? std::optional(entry->pw_uid) : std::nullopt;
}

bool is_trusted(uid_t user) {
  return user == 0 || user == ::geteuid() || user == service_user();
}

std::optional<Peer> peer_of(int socket) {
  ucred credentials{};
  socklen_t size = sizeof credentials;
  if (::getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &credentials, &size) != 0) return std::nullopt;
  return Peer{.process = credentials.pid,
              .user = credentials.uid,
              .trusted = is_trusted(credentials.uid) || in_service_group(socket, credentials.gid)};
}

bool daemon_answers(const std::string& socket_path) {
  const Descriptor socket = connect_to(socket_path);
  if (!socket) return false;
  const auto peer = peer_of(socket.get());
  if (!peer || !peer->trusted) return false;
  const ssize_t sent = ::send(socket.get(), question.data(), question.size(), MSG_NOSIGNAL);
  if (sent != static_cast<ssize_t>(question.size())) return false;
  const auto reply =
      nlohmann::json::parse(line_from(socket.get(), monotonic_now() + answer_patience), nullptr, false);
  return reply.is_object() && reply.contains("ok");
}

}  // namespace softgrip::daemon
