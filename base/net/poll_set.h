#pragma once
// Waits until one of several descriptors has an event.

#include <poll.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <vector>

#include "base/time.h"

namespace softgrip::net {

/// The set of descriptors for whose events a loop waits. Before each wait, clear the set and add all
/// descriptors.
class PollSet {
 public:
  /// The position of a descriptor in the set. A default-constructed position belongs to no descriptor and has
  /// no events.
  class Entry {
    friend PollSet;
    std::size_t index_ = SIZE_MAX;
  };
  enum class Outcome : std::uint8_t {
    done,  ///< the wait has ended, because of an event, a signal or the end of its longest time
    too_many_descriptors,  ///< the set has more descriptors than the process may have
    failed                 ///< the wait failed; errno contains the reason
  };
  class Events {
   public:
    explicit Events(short bits) noexcept : bits_(bits) {}
    [[nodiscard]] explicit operator bool() const noexcept { return bits_ != 0; }
    [[nodiscard]] bool input() const noexcept { return (bits_ & POLLIN) != 0; }
    [[nodiscard]] bool output() const noexcept { return (bits_ & POLLOUT) != 0; }
    /// Returns true after an error or a hang-up of the descriptor. The next read reports the error or the
    /// hang-up.
    [[nodiscard]] bool hangup_or_error() const noexcept { return (bits_ & (POLLERR | POLLHUP)) != 0; }
    [[nodiscard]] bool invalid() const noexcept { return (bits_ & POLLNVAL) != 0; }

   private:
    short bits_;
  };

  void clear() noexcept { polled_.clear(); }
  /// Adds a descriptor to the set. The descriptor -1 never has events. If `input` and `output` are false,
  /// only an error or a hang-up of the descriptor is an event.
  Entry add(int descriptor, bool input = true, bool output = false) {
    polled_.push_back({descriptor, static_cast<short>((input ? POLLIN : 0) | (output ? POLLOUT : 0)), 0});
    Entry entry;
    entry.index_ = polled_.size() - 1;
    return entry;
  }
  [[nodiscard]] Outcome wait(Nanoseconds longest) noexcept {
    const timespec limit{longest / ns_per_s, longest % ns_per_s};
    if (::ppoll(polled_.data(), polled_.size(), &limit, nullptr) >= 0 || errno == EINTR) return Outcome::done;
    return errno == EINVAL ? Outcome::too_many_descriptors : Outcome::failed;
  }
  /// Returns the events that the last wait found for a descriptor.
  [[nodiscard]] Events operator[](Entry entry) const noexcept {
    return Events(entry.index_ < polled_.size() ? polled_[entry.index_].revents : short{0});
  }

 private:
  std::vector<pollfd> polled_;
};

}  // namespace softgrip::net
