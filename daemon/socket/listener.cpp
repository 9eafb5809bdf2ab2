#include "daemon/socket/listener.h"

#include <grp.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/net/listener.h"

namespace softgrip::daemon {

namespace {

using Failure = tl::unexpected<std::string>;

Failure failure(const std::string& path, std::string_view what) {
  return Failure(fmt::format("{}: {}: {}", path, what, std::strerror(errno)));
}

/// Returns true if a program listens at the address. If no program listens, errno gives the reason.
bool is_listening(const sockaddr_un& address) {
  const Descriptor probe(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  return net::connect_unix(probe, address) || errno == EAGAIN;
}

/// Removes the socket file of a daemon that has ended. Returns false if a daemon responds on this socket.
bool remove_stale_socket(const sockaddr_un& address) {
  if (is_listening(address)) return false;
  // The kernel also refuses a connection to a file that is not a socket. Such a file is not removed, so
  // bind() reports that the file exists.
  struct stat status {};
  const bool refused = errno == ECONNREFUSED;
  if (refused && lstat(address.sun_path, &status) == 0 && S_ISSOCK(status.st_mode)) unlink(address.sun_path);
  return true;
}

/// Sets the mode and the group of the socket file.
bool set_permissions(const rig::SocketFile& file) {
  if (!file.group.empty()) {
    const group* entry = getgrnam(file.group.c_str());
    if (entry == nullptr) {
      errno = errno == 0 ? EINVAL : errno;
      return false;
    }
    if (chown(file.path.c_str(), static_cast<uid_t>(-1), entry->gr_gid) != 0) return false;
  }
  return chmod(file.path.c_str(), file.mode) == 0;
}

}  // namespace

Descriptor connect_to(const std::string& path) {
  const auto address = net::unix_address(path);
  if (path.empty() || !address) return {};
  Descriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!net::connect_unix(socket, *address)) socket.reset();
  return socket;
}

tl::expected<Listener, std::string> Listener::open(const rig::SocketFile& file) {
  const auto address = net::unix_address(file.path);
  if (!address) {
    return Failure(fmt::format("{}: the path of a socket may have at most {} bytes", file.path,
                               sizeof address->sun_path - 1));
  }
  if (!remove_stale_socket(*address))
    return Failure(fmt::format("{}: another softgripd already uses this socket", file.path));
  std::error_code ignored;
  std::filesystem::create_directories(std::filesystem::path(file.path).parent_path(), ignored);

  Descriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!socket) return failure(file.path, "socket");
  // bind() creates the socket file without permissions for other users, so that no other user can connect
  // before chmod().
  if (!net::bind_unix(socket, *address)) return failure(file.path, "bind");
  if (!set_permissions(file)) {
    const auto problem = failure(file.path, fmt::format("mode {:o} group '{}'", file.mode, file.group));
    unlink(file.path.c_str());
    return problem;
  }
  if (::listen(socket.get(), net::backlog) != 0) return failure(file.path, "listen");
  struct stat status {};
  if (lstat(file.path.c_str(), &status) != 0) return failure(file.path, "its own file");
  Listener listener(file.path, std::move(socket));
  listener.device_ = status.st_dev;
  listener.inode_ = status.st_ino;
  return listener;
}

Listener::~Listener() {
  struct stat status {};
  // Another daemon may have replaced this socket file by a file of its own. That file must not be removed.
  const bool exists = socket_ && lstat(path_.c_str(), &status) == 0;
  if (exists && status.st_dev == device_ && status.st_ino == inode_) unlink(path_.c_str());
}

}  // namespace softgrip::daemon
