#pragma once
// Defines the limits that decide whether a change is significant. Each limit is a probability, a number of
// evaluations or a property of repeated runs. No limit was tuned on simulated cases.

#include <cstddef>

namespace softgrip::sysid::limits {

/// Confidence level for the comparison of two hypotheses.
inline constexpr double probability = 0.95;
/// Number of independent quantities in which repeated runs of one finger differ: the offset, the gain, and
/// the creep that remains from the run before.
inline constexpr double run_directions = 3;
/// Number of bootstrap samples. With 500 samples, the standard error of a share of 0.95 is 1 %.
inline constexpr int bootstrap_draws = 500;
/// Largest number of units (units.h). Each unit is left out of one fit. If there are more runs than this
/// number, a unit contains several runs.
inline constexpr std::size_t most_units = 6;
/// Length of the blocks of a run that the bootstrap resamples as a whole [s]. It exceeds the duration of the
/// fast part of the creep.
inline constexpr double block_s = 5;
/// A pressure counts as zero if its distance from the lowest pressure is below this share of the pressure
/// range. The resolution of a valve near zero has about this size.
inline constexpr double rest_share = 0.05;
/// Smallest number of bins in which the condition of a cause must be fulfilled. In fewer bins, single noisy
/// samples could decide.
inline constexpr std::size_t fewest_bins = 5;
/// Confidence level of the test for feedback: 1 false detection in 1000 logs.
inline constexpr double feedback_probability = 0.999;
/// Largest noise of a command that was planned before the run, as a share of its standard deviation. The
/// noise of such a command is only the rounding in its file. The command of a controller also contains the
/// noise of the readings.
inline constexpr double planned_roughness = 1e-4;
/// Smallest phase_ratio() of a cross-correlation that counts as odd. Above this limit, the phase shift is
/// within 30 degrees of 90 degrees.
inline constexpr double odd_phase_ratio = 2.0 / 3;

}  // namespace softgrip::sysid::limits
