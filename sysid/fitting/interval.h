#pragma once
// A 95 % interval of a number, and how it is written.

#include <string>
#include <string_view>

namespace softgrip::sysid {

struct Interval {
  double lower = 0;
  double upper = 0;
};

/// "0.127 .. 0.133" with `between` " .. "; of an interval more than twenty times as wide as the value, that
/// these logs do not determine it.
[[nodiscard]] std::string text_of(const Interval& interval, double value, std::string_view between);
/// Whether the interval says anything of the value.
[[nodiscard]] bool is_determined(const Interval& interval, double value);

}  // namespace softgrip::sysid
