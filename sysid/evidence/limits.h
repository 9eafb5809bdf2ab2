#pragma once
// The numbers on which the evidence for a change rests. Each is a probability, a number of evaluations or a
// property of repeated runs. None comes from a study of simulated cases.

#include <cstddef>

namespace softgrip::sysid::limits {

/// A comparison decides at this probability: the customary level of a test.
inline constexpr double probability = 0.95;
/// Repeated runs of one finger differ in about three directions: offset, gain, and the creep that the run
/// before has left.
inline constexpr double run_directions = 3;
/// Draws of a bootstrap: the share of draws is then known to 1 % (one standard error).
inline constexpr int bootstrap_draws = 500;
/// At most so many fits leave a unit out. With more runs, several runs are left out together.
inline constexpr std::size_t most_units = 6;
/// Within a run, blocks of this length are drawn together [s]: longer than what a finger forgets at once.
inline constexpr double block_s = 5;
/// A pressure within this share of its range above the lowest is no pressure: the resolution of a valve near
/// zero.
inline constexpr double rest_share = 0.05;
/// A condition that fewer bins than this meet cannot show an effect: less would be one sample of noise.
inline constexpr std::size_t fewest_bins = 5;
/// A command counts as one that follows the readings at this probability: one log in a thousand by chance.
inline constexpr double feedback_probability = 0.999;
/// The noise of a planned command, as a share of its spread, is below this: only the resolution of its file
/// roughens it. A controller adds the noise of the readings.
inline constexpr double planned_roughness = 1e-4;
/// The phase of a loop counts as odd within 30 degrees of 90: a third of the way to 180.
inline constexpr double odd_phase_ratio = 2.0 / 3;

}  // namespace softgrip::sysid::limits
