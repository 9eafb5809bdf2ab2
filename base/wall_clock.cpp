#include "base/wall_clock.h"

#include <array>
#include <ctime>

#include "base/clock.h"

namespace softgrip {

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
