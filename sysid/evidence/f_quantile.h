#pragma once
// Computes quantiles of Fisher's F distribution.

namespace softgrip::sysid {

/// Returns a quantile of the F distribution (Abramowitz and Stegun 26.6). A random value with this
/// distribution is below the result with the given probability.
/// @param probability  in (0, 1).
/// @param above, below  degrees of freedom of numerator and denominator, >= 1.
[[nodiscard]] double f_quantile(double probability, double above, double below);

}  // namespace softgrip::sysid
