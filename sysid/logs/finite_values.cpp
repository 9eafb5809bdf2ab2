#include "sysid/logs/finite_values.h"

#include <algorithm>
#include <cmath>

namespace softgrip::sysid {

void fill_missing(std::vector<double>& column) {
  std::size_t last = column.size();  // index of the last finite value; column.size(): no value is finite
  for (std::size_t i = 0; i < column.size(); ++i) {
    if (!std::isfinite(column[i])) continue;
    const std::size_t from = last == column.size() ? 0 : last + 1;
    for (std::size_t j = from; j < i; ++j) {
      const double share =
          last == column.size() ? 1 : static_cast<double>(j - last) / static_cast<double>(i - last);
      column[j] = last == column.size() ? column[i] : column[last] + share * (column[i] - column[last]);
    }
    last = i;
  }
  for (std::size_t j = last + 1; j < column.size() && last < column.size(); ++j) column[j] = column[last];
}

FiniteValues finite_values(std::span<const double> column) {
  FiniteValues finite;
  for (std::size_t i = 0; i < column.size(); ++i) {
    if (!std::isfinite(column[i])) continue;
    finite.samples.push_back(i);
    finite.values.push_back(column[i]);
  }
  return finite;
}

std::size_t finite_count(std::span<const double> column) {
  return static_cast<std::size_t>(
      std::ranges::count_if(column, [](double value) { return std::isfinite(value); }));
}

std::optional<ColumnExtent> extent_of(std::span<const double> column) {
  std::optional<ColumnExtent> extent;
  for (const double value : column) {
    if (!std::isfinite(value)) continue;
    if (!extent) extent = ColumnExtent{value, value};
    extent->lowest = std::min(extent->lowest, value);
    extent->highest = std::max(extent->highest, value);
  }
  return extent;
}

double width_of(std::span<const double> column) {
  return extent_of(column).value_or(ColumnExtent{}).width();
}

bool varies(std::span<const double> column) {
  const auto extent = extent_of(column);
  return extent && extent->width() > 1e-6 * std::max(1.0, std::abs(extent->highest));
}

double largest_step(std::span<const double> column) {
  const std::vector<double> values = finite_values(column).values;
  double largest = 0;
  for (std::size_t i = 1; i < values.size(); ++i)
    largest = std::max(largest, std::abs(values[i] - values[i - 1]));
  return largest;
}

}  // namespace softgrip::sysid
