#include "base/wall_clock.h"

#include <array>
#include <ctime>

namespace softgrip {
namespace {

Nanoseconds read_clock(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return time.tv_sec * ns_per_s + time.tv_nsec;
}

}  // namespace

Nanoseconds wall_time(Nanoseconds monotonic) {
  return wall_time_now() - (read_clock(CLOCK_MONOTONIC) - monotonic);
}

Nanoseconds wall_time_now() {
  return read_clock(CLOCK_REALTIME);
}

std::string utc_text(Nanoseconds wall, int decimals) {
  const time_t whole = wall / ns_per_s;
  tm parts{};
  gmtime_r(&whole, &parts);
  std::array<char, 32> text{};
  strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%S", &parts);
  std::string result(text.data());
  if (decimals > 0) {
    // With nine digits: a leading 1 keeps the zeros.
    const std::string digits = std::to_string(ns_per_s + wall % ns_per_s);
    result += "." + digits.substr(1, static_cast<std::size_t>(decimals));
  }
  return result + "Z";
}

}  // namespace softgrip
