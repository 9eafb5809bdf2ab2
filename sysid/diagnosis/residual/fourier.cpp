#include "sysid/diagnosis/residual/fourier.h"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

namespace softgrip::sysid {

void fourier_transform(std::vector<Complex>& x) {
  const std::size_t n = x.size();
  for (std::size_t i = 1, j = 0; i < n; ++i) {
    std::size_t bit = n >> 1;
    for (; (j & bit) != 0; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) std::swap(x[i], x[j]);
  }
  for (std::size_t length = 2; length <= n; length <<= 1) {
    const Complex turn = std::polar(1.0, -2 * std::numbers::pi / static_cast<double>(length));
    for (std::size_t i = 0; i < n; i += length) {
      Complex w = 1;
      for (std::size_t k = 0; k < length / 2; ++k, w *= turn) {
        const Complex even = x[i + k], odd = w * x[i + k + length / 2];
        x[i + k] = even + odd;
        x[i + k + length / 2] = even - odd;
      }
    }
  }
}

}  // namespace softgrip::sysid
