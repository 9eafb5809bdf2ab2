#include "base/clock.h"

#include <ctime>
#include <limits>

#include "base/periodic_schedule.h"

namespace softgrip {

namespace {

Nanoseconds read_clock(clockid_t clock) noexcept {
  timespec now{};
  ::clock_gettime(clock, &now);
  return Nanoseconds{now.tv_sec} * ns_per_s + now.tv_nsec;
}

}  // namespace

Nanoseconds monotonic_now() noexcept {
  return read_clock(CLOCK_BOOTTIME);
}

Nanoseconds MonotonicClock::now() const noexcept {
  return monotonic_now();
}

void MonotonicClock::sleep_until(Nanoseconds due) const noexcept {
  softgrip::sleep_until(due);
}

Nanoseconds time_asleep() noexcept {
  // The scheduler can interrupt this thread between two reads of the clocks. The difference of the clocks is
  // then wrong. Therefore, the function measures three times and uses the measurement with the shortest
  // duration.
  Nanoseconds quickest = std::numeric_limits<Nanoseconds>::max();
  Nanoseconds ahead = 0;
  for (int i = 0; i < 3; ++i) {
    const Nanoseconds before = read_clock(CLOCK_MONOTONIC);
    const Nanoseconds counts_all = read_clock(CLOCK_BOOTTIME);
    const Nanoseconds took = read_clock(CLOCK_MONOTONIC) - before;
    if (took >= quickest) continue;
    quickest = took;
    ahead = counts_all - before;
  }
  constexpr Nanoseconds ms = ns_per_s / 1000;
  return (ahead + ms / 2) / ms * ms;
}

}  // namespace softgrip
