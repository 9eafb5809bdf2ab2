#pragma once
// How far the values of a column reach.

#include <optional>
#include <vector>

#include "model/output_unit.h"

namespace softgrip::sysid {

/// Below these a column is probably in another unit than kPa, mm or deg: a soft finger moves at 20 to 60 kPa
/// by some 10 mm, and bends by more than 3 deg, which is less than any finger in radians.
inline constexpr double small_pressure_kpa = 2;
[[nodiscard]] constexpr double small_reading(model::OutputUnit unit) {
  return unit == model::OutputUnit::deg ? 3 : 0.1;
}

struct ColumnExtent {
  double lowest = 0;
  double highest = 0;
  [[nodiscard]] double width() const { return highest - lowest; }
};

/// Of the values that are finite; none, if none is.
[[nodiscard]] std::optional<ColumnExtent> extent_of(const std::vector<double>& values);

}  // namespace softgrip::sysid
