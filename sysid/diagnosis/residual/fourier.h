#pragma once
// The discrete Fourier transform.

#include <complex>
#include <vector>

namespace softgrip::sysid {

using Complex = std::complex<double>;

/// X_k = sum_n x_n exp(-2 pi i k n / N) in place, by radix 2 (Cooley and Tukey 1965).
/// @param x  its size is a power of two.
void fourier_transform(std::vector<Complex>& x);

}  // namespace softgrip::sysid
