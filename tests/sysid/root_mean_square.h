#pragma once
// The root mean square for tests of fits.

#include <cmath>
#include <cstddef>
#include <span>

namespace softgrip::sysid::test {

/// Returns the root mean square of the finite values; 0 if there are none.
inline double rms(std::span<const double> values) {
  double sum = 0;
  std::size_t count = 0;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    sum += value * value;
    ++count;
  }
  return count == 0 ? 0 : std::sqrt(sum / static_cast<double>(count));
}

}  // namespace softgrip::sysid::test
