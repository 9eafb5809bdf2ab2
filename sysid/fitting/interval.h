#pragma once
// A 95 % confidence interval, and its conversion to text.

#include <cmath>
#include <string>
#include <string_view>

#include "base/numbers.h"

namespace softgrip::sysid {

struct Interval {
  double lower = 0;
  double upper = 0;
};

/// Returns true if the interval does not contain the value.
[[nodiscard]] inline bool excludes(const Interval& interval, double value) {
  return interval.lower > value || interval.upper < value;
}

/// Returns true if the logs determine the value: the interval is at most 20 times as wide as the magnitude of
/// the value.
[[nodiscard]] inline bool is_determined(const Interval& interval, double value) {
  constexpr double loose = 20;
  return interval.upper - interval.lower <= loose * std::abs(value);
}

/// Returns the interval as text, for example "0.127 .. 0.133" if `between` is " .. ". If is_determined() is
/// false, the text states that the logs do not determine the value.
[[nodiscard]] inline std::string text_of(const Interval& interval, double value, std::string_view between) {
  if (!is_determined(interval, value)) return "not determined by these logs";
  return significant(interval.lower, 4) + std::string(between) + significant(interval.upper, 4);
}

}  // namespace softgrip::sysid
