#include "base/descriptor.h"

#include <poll.h>

#include <cerrno>
#include <ctime>

#include "base/clock.h"

namespace softgrip {

Waited wait_for(int descriptor, short events, Nanoseconds deadline) noexcept {
  const MonotonicClock clock;
  while (true) {
    const Nanoseconds remaining = deadline - clock.now();
    if (remaining <= 0) return Waited::timed_out;
    const timespec timeout{.tv_sec = remaining / 1'000'000'000, .tv_nsec = remaining % 1'000'000'000};
    pollfd waiting{.fd = descriptor, .events = events, .revents = 0};
    const int ready = ::ppoll(&waiting, 1, &timeout, nullptr);
    if (ready > 0) return Waited::ready;
    if (ready < 0 && errno != EINTR) return Waited::failed;
  }
}

}  // namespace softgrip
