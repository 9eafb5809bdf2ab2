#pragma once
// Turning points of a signal, and a monotone approximation between them.

#include <cstddef>
#include <vector>

namespace softgrip::sysid {

/// Returns the indices of the first sample, of each sample after which the signal reverses by more than
/// `least`, and of the last sample; ascending. Of equal extreme values, the first is used. `values` must
/// contain at least one value, and all must be finite.
[[nodiscard]] std::vector<std::size_t> turning_points(const std::vector<double>& values, double least);

/// Returns the least-squares approximation that is monotone from each turning point to the next (pool
/// adjacent violators: Barlow, Bartholomew, Bremner and Brunk, Statistical Inference under Order
/// Restrictions, 1972). If the true signal is monotone there too, the sum of squared errors does not
/// increase.
[[nodiscard]] std::vector<double> steady_between_turns(std::vector<double> values, double least);

}  // namespace softgrip::sysid
