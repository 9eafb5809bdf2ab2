#include "base/statistics.h"

#include <algorithm>

namespace softgrip {

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
