#include "daemon/service/trusted_user.h"

#include <grp.h>
#include <pwd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <vector>

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
  return Peer{credentials.pid, credentials.uid,
              is_trusted(credentials.uid) || in_service_group(socket, credentials.gid)};
}

}  // namespace softgrip::daemon
