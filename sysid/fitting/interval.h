#pragma once
// A 95 % confidence interval, and its conversion to text.

#include <string>
#include <string_view>

namespace softgrip::sysid {

struct Interval {
  double lower = 0;
  double upper = 0;
};

/// Returns the interval as text, for example "0.127 .. 0.133" if `between` is " .. ". If is_determined() is
/// false, the text states that the logs do not determine the value.
[[nodiscard]] std::string text_of(const Interval& interval, double value, std::string_view between);
/// Returns true if the logs determine the value: the interval is at most 20 times as wide as the magnitude of
/// the value.
[[nodiscard]] bool is_determined(const Interval& interval, double value);

}  // namespace softgrip::sysid
