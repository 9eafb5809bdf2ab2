#pragma once
// Statistics that several rooms need.

#include <algorithm>
#include <cstddef>
#include <span>

namespace softgrip {

/// The value that half of the others do not exceed; of an even count the upper of the two in the middle. 0 of
/// none. Brings `values` into another order.
template <class T>
[[nodiscard]] T median_of(std::span<T> values) {
  if (values.empty()) return T{};
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Quantile of Student's t for a two-sided 95 % interval, by Cornish's and Fisher's expansion (Abramowitz and
/// Stegun 26.7.5); the error at 3 degrees of freedom is below 1 %.
[[nodiscard]] double t_quantile(double degrees_of_freedom);

}  // namespace softgrip
