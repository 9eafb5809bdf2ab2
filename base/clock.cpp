#include "base/clock.h"

#include <array>
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

Nanoseconds wall_time(Nanoseconds moment) {
  return wall_time_now() - (monotonic_now() - moment);
}

Nanoseconds wall_time_now() {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  return now.tv_sec * ns_per_s + now.tv_nsec;
}

std::string utc_text(Nanoseconds wall, int decimals) {
  const time_t whole = wall / ns_per_s;
  tm parts{};
  gmtime_r(&whole, &parts);
  std::array<char, 32> text{};
  strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%S", &parts);
  std::string result(text.data());
  if (decimals > 0) {
    // ns_per_s is added to get a number of ten digits, so that the text contains the leading zeros of the
    // fraction.
    const std::string digits = std::to_string(ns_per_s + wall % ns_per_s);
    result += "." + digits.substr(1, static_cast<std::size_t>(decimals));
  }
  return result + "Z";
}

}  // namespace softgrip
