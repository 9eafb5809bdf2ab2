#include "base/statistics.h"

#include <algorithm>
#include <vector>

namespace softgrip {

double third_difference_noise(std::span<const double> values) {
  std::vector<double> sizes;
  for (std::size_t i = 3; i < values.size(); ++i)
    sizes.push_back(std::abs(values[i] - 3 * values[i - 1] + 3 * values[i - 2] - values[i - 3]));
  // The third difference has the weights 1, -3, 3 and -1, whose squares add up to 20. The median magnitude of
  // a standard normal variable is 0.6745.
  return median_of(std::span(sizes)) / (0.6745 * std::sqrt(20.0));
}

double t_quantile(double degrees_of_freedom) {
  constexpr double z = 1.959963984540054;
  const double v = std::max(degrees_of_freedom, 2.0);
  const double z3 = z * z * z;
  const double z5 = z3 * z * z;
  const double z7 = z5 * z * z;
  return z + (z3 + z) / (4 * v) + (5 * z5 + 16 * z3 + 3 * z) / (96 * v * v) +
         (3 * z7 + 19 * z5 + 17 * z3 - 15 * z) / (384 * v * v * v);
}

}  // namespace softgrip
