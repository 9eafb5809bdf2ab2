#include "daemon/service/board_lock.h"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <set>

#include <fmt/format.h>

#include "base/sha256.h"

namespace softgrip::daemon {

namespace {

/// Of an IPv4 address that is written as one of IPv6.
constexpr std::array<unsigned char, 12> mapped_prefix{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff};

/// "::1" and "0:0::1" are one board, as are "::ffff:10.0.0.5" and "10.0.0.5".
std::string numeric(const std::string& host) {
  std::array<unsigned char, sizeof(in6_addr)> address{};
  std::array<char, INET6_ADDRSTRLEN> text{};
  for (const int family : {AF_INET, AF_INET6}) {
    if (inet_pton(family, host.c_str(), address.data()) != 1) continue;
    const bool mapped =
        family == AF_INET6 && std::equal(mapped_prefix.begin(), mapped_prefix.end(), address.begin());
    const unsigned char* const bytes = mapped ? address.data() + mapped_prefix.size() : address.data();
    if (inet_ntop(mapped ? AF_INET : family, bytes, text.data(), text.size()) != nullptr) return text.data();
  }
  return host;
}

std::string real_path(const std::string& path) {
  std::error_code error;
  const std::filesystem::path real = std::filesystem::canonical(path, error);
  return error ? path : real.string();
}

std::string name_of(const drivers::ModbusAddress& link, std::uint8_t unit) {
  if (const auto* tcp = std::get_if<drivers::TcpAddress>(&link))
    return fmt::format("modbus {} port {} unit {}", numeric(tcp->host), tcp->port, unit);
  // A serial line has one master, whatever units it asks.
  return "serial " + real_path(std::get<drivers::SerialLine>(link).device);
}

/// A name in the kernel, not in a folder: nobody can remove it, and it goes when its process goes.
sockaddr_un address_of(const std::string& name, socklen_t& length) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string key = "softgrip-board-" + sha256(name);
  std::memcpy(address.sun_path + 1, key.data(), key.size());
  length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + key.size());
  return address;
}

/// " (process 4711)", or nothing.
std::string holder(const sockaddr_un& address, socklen_t length) {
  const Descriptor probe(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  ucred peer{};
  socklen_t size = sizeof peer;
  const bool known = connect(probe.get(), reinterpret_cast<const sockaddr*>(&address), length) == 0 &&
                     getsockopt(probe.get(), SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0;
  return known ? fmt::format(" (process {})", peer.pid) : "";
}

}  // namespace

std::vector<std::string> driven_by(const rig::RigFile& rig) {
  std::set<std::string> names;
  if (const auto* modbus = std::get_if<drivers::ModbusSettings>(&rig.board)) {
    for (const drivers::ModbusModuleSettings& module : modbus->modules) {
      if (module.map.outputs.registers.count > 0)
        names.insert(name_of(modbus->links[module.link], module.unit));
    }
  }
  if (const auto* converters = std::get_if<drivers::IioSettings>(&rig.board)) {
    for (const drivers::IioTerminal& output : converters->outputs)
      names.insert(fmt::format("converter {} of {}", output.device, real_path(converters->root)));
  }
  return {names.begin(), names.end()};
}

tl::expected<BoardLock, std::string> BoardLock::take(const rig::RigFile& rig) {
  BoardLock lock;
  for (const std::string& name : driven_by(rig)) {
    socklen_t length = 0;
    const sockaddr_un address = address_of(name, length);
    Descriptor held(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
    if (bind(held.get(), reinterpret_cast<const sockaddr*>(&address), length) != 0) {
      if (errno != EADDRINUSE) return tl::unexpected(fmt::format("{}: {}", name, std::strerror(errno)));
      return tl::unexpected(
          fmt::format("{}: another softgrip program drives this board{}; two masters would fight", name,
                      holder(address, length)));
    }
    // Only a socket that listens says who has it.
    if (listen(held.get(), 1) != 0) return tl::unexpected(fmt::format("{}: {}", name, std::strerror(errno)));
    lock.held_.push_back(std::move(held));
  }
  return lock;
}

}  // namespace softgrip::daemon
