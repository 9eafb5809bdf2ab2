#include "base/clock.h"

#include <ctime>

#include "base/grid.h"

namespace softgrip {

Nanoseconds monotonic_now() noexcept {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return Nanoseconds{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

Nanoseconds MonotonicClock::now() const noexcept {
  return monotonic_now();
}

void MonotonicClock::sleep_until(Nanoseconds due) const noexcept {
  softgrip::sleep_until(due);
}

}  // namespace softgrip
