#pragma once
// Defines an object that owns a file descriptor and closes it on destruction.
// Waits until a descriptor is ready or a deadline has passed.

#include <unistd.h>

#include <cstdint>
#include <utility>

#include "base/time.h"

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
[[nodiscard]] Waited wait_for(int descriptor, short events, Nanoseconds deadline) noexcept;

}  // namespace softgrip
