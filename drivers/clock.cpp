#include "drivers/clock.h"

#include <ctime>

namespace softgrip::drivers {

model::Nanoseconds MonotonicClock::now() const noexcept {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return model::Nanoseconds{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

}  // namespace softgrip::drivers
