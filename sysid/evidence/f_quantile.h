#pragma once
// Computes quantiles of Fisher's F distribution.

namespace softgrip::sysid {

/// Returns the value that an F-distributed ratio does not exceed with the given probability (Abramowitz and
/// Stegun 26.6).
/// @param probability  in (0, 1).
/// @param above, below  degrees of freedom of numerator and denominator, >= 1.
[[nodiscard]] double f_quantile(double probability, double above, double below);

}  // namespace softgrip::sysid
