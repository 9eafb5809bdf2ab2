#include "sysid/logs/sensor_codes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <set>

#include "sysid/logs/finite_values.h"

namespace softgrip::sysid {
namespace {

constexpr std::array code_values{
    999.0,   9999.0,   99999.0,  999999.0,  999.9,        9999.9,        999.99,      9999.99, 99.99,
    -999.0,  -9999.0,  -99999.0, -999.9,    -99.9,        -99.99,        -999.99,     888.0,   8888.0,
    32767.0, -32768.0, 65535.0,  8388607.0, 2147483647.0, -2147483648.0, 4294967295.0};
constexpr double farther_outside = 10;
constexpr std::size_t fewest_repeats = 3;
constexpr double most_codes = 0.5;

bool is_code_value(double value) {
  return std::find(code_values.begin(), code_values.end(), value) != code_values.end() ||
         std::abs(value) > 1e29;
}

/// Range of the values that are no codes.
struct OtherValues {
  double lowest = 0;
  double highest = 0;

  [[nodiscard]] double distance_to(double value) const {
    return std::max({value - highest, lowest - value, 0.0});
  }
};

/// Returns the suspects that a motion reaches: next to such a value there is a reading that is nearer to it
/// than to the range of the other values. A motion approaches a position through intermediate values, whereas
/// a reading jumps to an error code and back.
std::set<double> reached_by_motion(std::span<const double> values,
                                   const std::map<double, std::size_t>& suspects, const OtherValues& others) {
  std::set<double> reached;
  std::optional<double> before;
  const auto compare = [&](double value, double neighbour) {
    const bool is_near = value != neighbour && !is_code_value(neighbour) &&
                         std::abs(value - neighbour) < others.distance_to(neighbour);
    if (is_near && suspects.contains(value)) reached.insert(value);
  };
  for (const double value : finite_values(values).values) {
    if (before) {
      compare(value, *before);
      compare(*before, value);
    }
    before = value;
  }
  return reached;
}

}  // namespace

std::vector<double> sensor_codes(std::span<const double> values, CodeKinds kinds) {
  std::map<double, std::size_t> suspects;
  std::vector<double> sorted = finite_values(values).values;
  std::sort(sorted.begin(), sorted.end());
  if (sorted.size() < 20) return {};
  const double low = sorted[sorted.size() / 20];
  const double high = sorted[sorted.size() - 1 - sorted.size() / 20];
  std::vector<double> others;
  for (const double value : sorted) {
    const bool far =
        value < low - farther_outside * (high - low) || value > high + farther_outside * (high - low);
    if (is_code_value(value) || (far && high > low && kinds == CodeKinds::any)) {
      ++suspects[value];
    } else {
      others.push_back(value);
    }
  }
  if (others.size() < 2 ||
      static_cast<double>(others.size()) < most_codes * static_cast<double>(sorted.size()))
    return {};
  OtherValues range{others.front(), others.back()};
  for (const double value : reached_by_motion(values, suspects, range)) {
    suspects.erase(value);
    range.lowest = std::min(range.lowest, value);
    range.highest = std::max(range.highest, value);
  }
  const double span = range.highest - range.lowest;
  std::vector<double> codes;
  for (const auto& [value, count] : suspects) {
    const bool outside = range.distance_to(value) > far_outside * span;
    if (span > 0 && outside && (is_code_value(value) || count >= fewest_repeats)) codes.push_back(value);
  }
  return codes;
}

}  // namespace softgrip::sysid
