#include "sysid/fitting/interval.h"

#include <cmath>

#include "base/numbers.h"

namespace softgrip::sysid {

bool is_determined(const Interval& interval, double value) {
  constexpr double loose = 20;
  return interval.upper - interval.lower <= loose * std::abs(value);
}

std::string text_of(const Interval& interval, double value, std::string_view between) {
  if (!is_determined(interval, value)) return "not determined by these logs";
  return significant(interval.lower, 4) + std::string(between) + significant(interval.upper, 4);
}

}  // namespace softgrip::sysid
