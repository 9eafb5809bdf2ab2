#pragma once
// Limits that decide whether a change is significant. Each of them is a probability, a number of evaluations
// or a property of repeated runs. None of them was tuned on simulated cases.

#include <cstddef>

namespace softgrip::sysid::limits {

/// Confidence level of a comparison.
inline constexpr double probability = 0.95;
/// Number of independent ways in which repeated runs of one finger differ: offset, gain, and creep that
/// remains from the previous run.
inline constexpr double run_directions = 3;
/// Number of bootstrap samples. With 500 samples, the standard error of a share of 0.95 is 1 %.
inline constexpr int bootstrap_draws = 500;
/// Largest number of units (units.h), which are left out one by one. With more runs, a unit contains several
/// runs.
inline constexpr std::size_t most_units = 6;
/// Length of the blocks of a run that are resampled as a whole [s]. It is longer than the fast part of the
/// creep.
inline constexpr double block_s = 5;
/// Limit below which a pressure counts as zero: distance from the lowest pressure as a share of the pressure
/// range. The resolution of a valve near zero has about this size.
inline constexpr double rest_share = 0.05;
/// Smallest number of bins in which the condition of a cause must be met. With fewer bins, single noisy
/// samples could decide.
inline constexpr std::size_t fewest_bins = 5;
/// Confidence level of the test for feedback, which corresponds to 1 false detection in 1000 logs.
inline constexpr double feedback_probability = 0.999;
/// Upper limit of the noise of a planned command, as a share of its standard deviation. The noise of a
/// planned command is the rounding in its file, whereas the command of a controller also contains the noise
/// of the readings.
inline constexpr double planned_roughness = 1e-4;
/// Smallest phase ratio of an odd cross-correlation. Above this limit, the phase lies within 30 degrees of 90
/// degrees.
inline constexpr double odd_phase_ratio = 2.0 / 3;

}  // namespace softgrip::sysid::limits
