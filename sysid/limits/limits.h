#pragma once
// Defines the limits that several searches, comparisons, conditions and verdicts use. Each limit is a
// probability, a number of evaluations, a share of an error or a physical tolerance.

#include <cstddef>

namespace softgrip::sysid::limits {

// Probabilities

/// Confidence level of intervals and of the comparison of two hypotheses.
inline constexpr double probability = 0.95;
/// Confidence level of a decision that is made without a comparison of hypotheses: 1 error in 1000 decisions.
inline constexpr double strict_probability = 0.999;
/// Half the width of an interval at the level `probability`, in standard errors (normal distribution).
inline constexpr double deviate = 1.96;
/// Value that a standard normal variable exceeds with the probability 1 - strict_probability.
inline constexpr double strict_deviate = 3.09;
/// Natural logarithm of a likelihood ratio of 1000.
inline constexpr double strict_log_likelihood = 6.9;

// Numbers of evaluations

/// Number of bootstrap samples. With 1000 samples, the standard error of a share of 0.95 is 0.7 %.
inline constexpr std::size_t bootstrap_draws = 1000;
/// Largest number of units (sysid/evidence/units.h). Each unit is left out of one fit. If there are more runs
/// than this number, a unit contains several runs.
inline constexpr std::size_t most_units = 6;
/// Number of candidates that each stage of a search passes to its next stage. Each candidate costs one fit.
inline constexpr std::size_t finalists = 5;
/// Number of start points from which each candidate is continued. A second start point shows that the first
/// one led to a local minimum.
inline constexpr std::size_t followed_starts = 2;
/// Number of start points of a fit that repeats an earlier search or only gives a rough base. A complete
/// search uses more start points.
inline constexpr std::size_t repeated_starts = 6;
/// Largest number of alternatives that are examined or listed for one cause. A user cannot test more.
inline constexpr std::size_t most_alternatives = 4;
/// Smallest number of events (jumps, intervals, samples, simulations) for a test at the level 1 -
/// probability. One exception in 20 events has this level.
inline constexpr std::size_t fewest_events = 20;
/// Smallest number of occurrences that can decide, for example bins in which the condition of a cause is
/// fulfilled. With fewer occurrences, single noisy samples could decide.
inline constexpr std::size_t fewest_occurrences = 5;

/// Smallest number of values from which a correlation is estimated. The standard error of a correlation of 15
/// values is 0.26.
inline constexpr std::size_t fewest_for_correlation = 15;

// Shares of an error

/// An improvement by this share (of the mean square, of the RMSE or of the noise variance) is negligible,
/// even if it is significant. No noise is known to more than 1 %.
inline constexpr double negligible_share = 0.01;
/// Share of an error that can remain after a fit because the equation of a cause or of a model is an
/// approximation. Published models of soft fingers leave a few percent.
inline constexpr double form_error_share = 0.05;
/// If the errors of two hypotheses differ by less than this share, the simpler hypothesis is kept.
inline constexpr double equal_error_share = 0.1;
/// Candidates are compared further while their error is at most this multiple of the smallest error.
inline constexpr double comparable_ratio = 1.25;
/// An input is unfamiliar if it increases the permitted mean square error by more than this factor.
inline constexpr double unfamiliar_factor = 1 + equal_error_share;
/// Smallest share of the remaining error that a hypothesis must explain to count as an explanation.
inline constexpr double least_explained_share = 0.2;
/// Smallest share of a quantity to which a hypothesis applies that counts as most of this quantity.
inline constexpr double majority_share = 0.5;

// Multiples of the noise of the readings

/// An error below this multiple of the noise cannot be seen in the readings.
inline constexpr double hidden_by_noise = 0.25;
/// An error below this multiple of the noise can be seen, but it changes the mean square by at most a quarter
/// of the noise variance. It gives no reason for a further search.
inline constexpr double tolerated_noise = 0.5;

// Physical tolerances

/// Number of independent quantities in which repeated runs of one finger differ: the offset, the gain, and
/// the creep that remains from the run before.
inline constexpr double run_directions = 3;
/// Length of the blocks of a run that the bootstrap resamples as a whole [s]. It exceeds the duration of the
/// fast part of the creep.
inline constexpr double block_s = 5;
/// A pressure counts as zero if its distance from the lowest pressure is below this share of the pressure
/// range. The resolution of a valve near zero has about this size.
inline constexpr double rest_share = 0.05;
/// A command counts as constant while it changes by at most this share of the full pressure.
inline constexpr double constant_command_share = 0.02;
/// Sample interval of the records in a search [s]. The lags of valves and the resonances of fingers are
/// longer.
inline constexpr double search_interval_s = 0.02;
/// Sample interval that is sufficient for a finger whose input is its pressure [s]. A finger responds more
/// slowly than a valve.
inline constexpr double finger_interval_s = 0.05;
/// Largest noise of a command that was planned before the run, as a share of its standard deviation. The
/// noise of such a command is only the rounding in its file. The command of a controller also contains the
/// noise of the readings.
inline constexpr double planned_roughness = 1e-4;
/// Smallest phase_ratio() of a cross-correlation that counts as odd. Above this limit, the phase shift is
/// within 30 degrees of 90 degrees.
inline constexpr double odd_phase_ratio = 2.0 / 3;

}  // namespace softgrip::sysid::limits
