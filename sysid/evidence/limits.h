#pragma once
// Limits that decide whether a change is significant. Each is a probability, a number of evaluations or a
// property of repeated runs. None was tuned on simulated cases.

#include <cstddef>

namespace softgrip::sysid::limits {

/// Confidence level of a comparison: the customary 95 %.
inline constexpr double probability = 0.95;
/// Repeated runs of one finger differ in about three directions: offset, gain, and creep that remains from
/// the previous run.
inline constexpr double run_directions = 3;
/// Number of bootstrap draws. The standard error of a share of 0.95 is then 1 %.
inline constexpr int bootstrap_draws = 500;
/// Largest number of fits that leave a unit out. With more runs, a unit contains several runs.
inline constexpr std::size_t most_units = 6;
/// Length of the blocks of a run that are resampled together [s], longer than the fast part of the creep.
inline constexpr double block_s = 5;
/// A pressure counts as zero if it is at most this share of the pressure range above the lowest pressure. The
/// resolution of a valve near zero is of this size.
inline constexpr double rest_share = 0.05;
/// Smallest number of bins that meet a condition. With fewer bins, single noisy samples could decide.
inline constexpr std::size_t fewest_bins = 5;
/// Confidence level of the test for feedback: 1 false detection in 1000 logs.
inline constexpr double feedback_probability = 0.999;
/// Upper limit of the noise of a planned command as a share of its standard deviation. A planned command
/// contains only the rounding of its file. The command of a controller also contains the noise of the
/// readings.
inline constexpr double planned_roughness = 1e-4;
/// Lower limit of the phase ratio of an odd correlation: the phase lies within 30 degrees of 90 degrees.
inline constexpr double odd_phase_ratio = 2.0 / 3;

}  // namespace softgrip::sysid::limits
