#pragma once
// Finds the turning points of a signal, and approximates the signal by a monotone curve between them.

#include <cstddef>
#include <vector>

namespace softgrip::sysid {

/// Returns the indices of three kinds of samples in ascending order: the first sample, each sample after
/// which the signal reverses by more than `least`, and the last sample. If an extreme value occurs several
/// times, its first sample is used. `values` must contain at least one value, and all values must be finite.
[[nodiscard]] std::vector<std::size_t> turning_points(const std::vector<double>& values, double least);

/// Returns the least-squares approximation of `values` that is monotone between consecutive turning points
/// (pool adjacent violators: Barlow, Bartholomew, Bremner and Brunk, Statistical Inference under Order
/// Restrictions, 1972). If the true signal is monotone between these points too, the approximation is at
/// least as close to the true signal as `values`, measured by the sum of squared errors.
[[nodiscard]] std::vector<double> steady_between_turns(std::vector<double> values, double least);

}  // namespace softgrip::sysid
