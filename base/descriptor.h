#pragma once
// Defines an object that owns a file descriptor and closes it on destruction.
// Waits until a descriptor is ready or a deadline has passed.

#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <ctime>
#include <utility>

#include "base/clock.h"

namespace softgrip {

class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int number) noexcept : number_(number) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor() { reset(); }

  [[nodiscard]] int get() const noexcept { return number_; }
  void reset() noexcept {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }
  /// Returns the descriptor and gives up its ownership, so the caller must close the descriptor.
  [[nodiscard]] int release() noexcept { return std::exchange(number_, -1); }
  [[nodiscard]] explicit operator bool() const noexcept { return number_ >= 0; }

 private:
  int number_ = -1;
};

enum class Waited : std::uint8_t {
  ready,      ///< the descriptor is ready, or has an error or a hang-up, which the next call on the
              ///< descriptor reports
  timed_out,  ///< the deadline has passed before the descriptor was ready
  failed,     ///< waiting failed; errno contains the reason
};

/// Waits for events of poll() until `deadline` on CLOCK_BOOTTIME. select() is not used, because it does not
/// accept descriptors above 1023.
[[nodiscard]] inline Waited wait_for(int descriptor, short events, Nanoseconds deadline) noexcept {
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
