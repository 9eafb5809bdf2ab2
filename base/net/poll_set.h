#pragma once
// Waits for events of several descriptors.

#include <poll.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <vector>

#include "base/time.h"

namespace softgrip::net {

/// The descriptors for whose events a loop waits. Before each wait, clear the set and add all descriptors.
class PollSet {
 public:
  /// The place of a descriptor in the set. The default place has no descriptor and no events.
  class Place {
    friend PollSet;
    std::size_t index_ = SIZE_MAX;
  };
  enum class Outcome : std::uint8_t {
    over,      ///< the wait is over: because of an event, a signal or its longest time
    too_many,  ///< the set has more descriptors than the process may have
    failed     ///< errno contains the reason
  };
  class Events {
   public:
    explicit Events(short bits) noexcept : bits_(bits) {}
    [[nodiscard]] explicit operator bool() const noexcept { return bits_ != 0; }
    [[nodiscard]] bool input() const noexcept { return (bits_ & POLLIN) != 0; }
    [[nodiscard]] bool output() const noexcept { return (bits_ & POLLOUT) != 0; }
    /// Returns true after an error or a hang-up, which the next read reports.
    [[nodiscard]] bool ended() const noexcept { return (bits_ & (POLLERR | POLLHUP)) != 0; }
    [[nodiscard]] bool invalid() const noexcept { return (bits_ & POLLNVAL) != 0; }

   private:
    short bits_;
  };

  void clear() noexcept { polled_.clear(); }
  /// Adds a descriptor; -1 never has events. Without input and output, only its end is an event.
  Place add(int descriptor, bool input = true, bool output = false) {
    polled_.push_back({descriptor, static_cast<short>((input ? POLLIN : 0) | (output ? POLLOUT : 0)), 0});
    Place place;
    place.index_ = polled_.size() - 1;
    return place;
  }
  [[nodiscard]] Outcome wait(Nanoseconds longest) noexcept {
    const timespec limit{longest / ns_per_s, longest % ns_per_s};
    if (::ppoll(polled_.data(), polled_.size(), &limit, nullptr) >= 0 || errno == EINTR) return Outcome::over;
    return errno == EINVAL ? Outcome::too_many : Outcome::failed;
  }
  /// Returns the events of the last wait.
  [[nodiscard]] Events operator[](Place place) const noexcept {
    return Events(place.index_ < polled_.size() ? polled_[place.index_].revents : short{0});
  }

 private:
  std::vector<pollfd> polled_;
};

}  // namespace softgrip::net
