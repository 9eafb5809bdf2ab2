#include "base/net/entrance.h"

#include <fcntl.h>

#include <cerrno>
#include <utility>

#include "base/net/listener.h"

namespace softgrip::net {

Entrance::Entrance(Descriptor listener) : listener_(std::move(listener)) {
  take_spares();
}

Descriptor Entrance::accept(Nanoseconds now) {
  take_spares();
  Descriptor client = accept_client(listener_);
  short_ = !client && is_shortage(errno);
  if (!short_) return client;
  for (Descriptor& spare : spares_) spare.reset();
  client = accept_client(listener_);
  if (!client) rests_until_ = now + rest;
  return client;
}

void Entrance::take_spares() noexcept {
  for (Descriptor& spare : spares_) {
    if (!spare && listener_) spare = Descriptor{::fcntl(listener_.get(), F_DUPFD_CLOEXEC, 0)};
  }
}

}  // namespace softgrip::net
