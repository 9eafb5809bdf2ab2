#pragma once
// Reads the finite values of a column. A value that is not finite means that the column has no value at this
// sample.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace softgrip::sysid {

/// The finite values of a column, with the index of the sample of each value.
struct FiniteValues {
  std::vector<std::size_t> samples;
  std::vector<double> values;
};
[[nodiscard]] FiniteValues finite_values(std::span<const double> column);

[[nodiscard]] std::size_t finite_count(std::span<const double> column);

/// Replaces missing values by linear interpolation between their neighbours, and at the ends by the nearest
/// value. A column without any value stays unchanged.
void fill_missing(std::vector<double>& column);

struct ColumnExtent {
  double lowest = 0;
  double highest = 0;
  [[nodiscard]] double width() const { return highest - lowest; }
};

/// Returns the range of the finite values, or nullopt if no value is finite.
[[nodiscard]] std::optional<ColumnExtent> extent_of(std::span<const double> column);

/// Returns the difference between the largest and the smallest finite value; 0 if no value is finite.
[[nodiscard]] double width_of(std::span<const double> column);

/// Returns true if the finite values differ by more than rounding errors.
[[nodiscard]] bool varies(std::span<const double> column);

/// Returns the largest step between neighbouring finite values; 0 if there are fewer than two.
[[nodiscard]] double largest_step(std::span<const double> column);

}  // namespace softgrip::sysid
