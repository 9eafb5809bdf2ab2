#pragma once
// Where a signal turns back, and what it does between its turns.

#include <cstddef>
#include <vector>

namespace softgrip::sysid {

/// The first sample, every sample from which the signal then goes back by more than `least`, the last one;
/// ascending. Among equal highest (lowest) values, the first counts. At least one value, all finite.
[[nodiscard]] std::vector<std::size_t> turning_points(const std::vector<double>& values, double least);

/// The nearest signal, in the sense of least squares, that rises or falls steadily from one turning point to
/// the next (pool adjacent violators: Barlow, Bartholomew, Bremner and Brunk, Statistical Inference under
/// Order Restrictions, 1972). Where the truth does so too, no sum of squared errors grows.
[[nodiscard]] std::vector<double> steady_between_turns(std::vector<double> values, double least);

}  // namespace softgrip::sysid
