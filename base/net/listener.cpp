#include "base/net/listener.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <utility>

namespace softgrip::net {
namespace {

/// First 12 bytes of an IPv4 address that is written as an IPv6 address.
constexpr std::array<unsigned char, 12> mapped_prefix{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff};

tl::unexpected<std::string> failure(const std::string& what) {
  return tl::unexpected{"cannot listen on " + what + ": " + std::strerror(errno)};
}

using AddressList = std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)>;

/// Converts a numeric address and a port to a socket address. Returns null if the address is not numeric.
AddressList numeric(const std::string& address, const std::string& port) {
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV | AI_PASSIVE;
  addrinfo* found = nullptr;
  if (::getaddrinfo(address.c_str(), port.c_str(), &hints, &found) != 0) found = nullptr;
  return {found, &::freeaddrinfo};
}

std::uint16_t port_of(int socket) {
  sockaddr_storage storage{};
  socklen_t size = sizeof storage;
  if (::getsockname(socket, reinterpret_cast<sockaddr*>(&storage), &size) != 0) return 0;
  if (storage.ss_family == AF_INET6) return ntohs(reinterpret_cast<const sockaddr_in6&>(storage).sin6_port);
  return ntohs(reinterpret_cast<const sockaddr_in&>(storage).sin_port);
}

}  // namespace

bool is_numeric(const std::string& address) {
  in6_addr bytes{};
  return ::inet_pton(AF_INET, address.c_str(), &bytes) == 1 ||
         ::inet_pton(AF_INET6, address.c_str(), &bytes) == 1;
}

std::string normal_address(const std::string& address) {
  std::array<unsigned char, sizeof(in6_addr)> binary{};
  std::array<char, INET6_ADDRSTRLEN> text{};
  for (const int family : {AF_INET, AF_INET6}) {
    if (::inet_pton(family, address.c_str(), binary.data()) != 1) continue;
    const bool mapped =
        family == AF_INET6 && std::equal(mapped_prefix.begin(), mapped_prefix.end(), binary.begin());
    const unsigned char* const bytes = mapped ? binary.data() + mapped_prefix.size() : binary.data();
    if (::inet_ntop(mapped ? AF_INET : family, bytes, text.data(), text.size()) != nullptr)
      return text.data();
  }
  return address;
}

bool is_loopback(const std::string& address) {
  in_addr four{};
  if (::inet_pton(AF_INET, address.c_str(), &four) == 1) return ntohl(four.s_addr) >> 24U == 127;
  in6_addr six{};
  return ::inet_pton(AF_INET6, address.c_str(), &six) == 1 && IN6_IS_ADDR_LOOPBACK(&six);
}

tl::expected<Listener, std::string> listen_tcp(const std::string& address, std::uint16_t port) {
  const std::string what = address + ":" + std::to_string(port);
  const AddressList found = numeric(address, std::to_string(port));
  if (!found) return tl::unexpected{"'" + address + "' is no numeric IPv4 or IPv6 address"};
  Descriptor socket{::socket(found->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)};
  const int on = 1;
  if (!socket || ::setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) != 0 ||
      ::bind(socket.get(), found->ai_addr, found->ai_addrlen) != 0 || ::listen(socket.get(), backlog) != 0) {
    return failure(what);
  }
  const std::uint16_t bound = port_of(socket.get());
  return Listener{std::move(socket), bound};
}

std::optional<sockaddr_un> unix_address(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) return std::nullopt;
  std::memcpy(address.sun_path, path.data(), path.size());
  return address;
}

bool connect_unix(const Descriptor& socket, const sockaddr_un& address) noexcept {
  return ::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
}

bool bind_unix(const Descriptor& socket, const sockaddr_un& address) noexcept {
  const mode_t mask = ::umask(0177);
  const int bound = ::bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address);
  ::umask(mask);
  return bound == 0;
}

tl::expected<Descriptor, std::string> listen_unix(const std::string& path) {
  const auto address = unix_address(path);
  if (!address) return tl::unexpected{"the path " + path + " is too long for a socket"};
  struct stat status {};
  if (::lstat(path.c_str(), &status) == 0 && S_ISSOCK(status.st_mode)) ::unlink(path.c_str());
  Descriptor socket{::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)};
  if (!socket || !bind_unix(socket, *address) || ::listen(socket.get(), backlog) != 0) return failure(path);
  return socket;
}

Descriptor accept_client(const Descriptor& listener) {
  Descriptor client{::accept4(listener.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC)};
  if (client) {
    // The option TCP_NODELAY sends small replies without delay. On a Unix socket, this option has no effect.
    const int on = 1;
    ::setsockopt(client.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  }
  return client;
}

bool is_descriptor_shortage(int error) noexcept {
  return error == EMFILE || error == ENFILE || error == ENOBUFS || error == ENOMEM;
}

Acceptor::Acceptor(Descriptor listener) : listener_(std::move(listener)) {
  reserve_spares();
}

Descriptor Acceptor::accept(Nanoseconds now) {
  reserve_spares();
  Descriptor client = accept_client(listener_);
  out_of_descriptors_ = !client && is_descriptor_shortage(errno);
  if (!out_of_descriptors_) return client;
  for (Descriptor& spare : spares_) spare.reset();
  client = accept_client(listener_);
  if (!client) paused_until_ = now + retry_pause;
  return client;
}

void Acceptor::reserve_spares() noexcept {
  for (Descriptor& spare : spares_) {
    if (!spare && listener_) spare = Descriptor{::fcntl(listener_.get(), F_DUPFD_CLOEXEC, 0)};
  }
}

}  // namespace softgrip::net
