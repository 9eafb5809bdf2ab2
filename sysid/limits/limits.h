#pragma once
// Defines the limits that are used by more than one search, comparison, condition or verdict. A limit is a
// probability, a number of evaluations, a share of an error or a physical tolerance.

#include <cstddef>

namespace softgrip::sysid::limits {

// Probabilities

/// Confidence level of intervals and of comparisons between two hypotheses.
inline constexpr double probability = 0.95;
/// Confidence level of a decision that is not based on a comparison of two hypotheses. It corresponds to 1
/// wrong decision in 1000.
inline constexpr double strict_probability = 0.999;
/// Half of the width of a confidence interval at the level `probability`, in standard errors (normal
/// distribution).
inline constexpr double deviate = 1.96;
/// Value that a standard normal variable exceeds with the probability 1 - strict_probability = 0.001.
inline constexpr double strict_deviate = 3.09;
/// Natural logarithm of the likelihood ratio of 1000 that is required for a decision between two hypotheses.
inline constexpr double strict_log_likelihood = 6.9;

// Numbers of evaluations

/// Number of bootstrap samples. With 1000 samples, the standard error of a share of 95 % is 0.7 percentage
/// points.
inline constexpr std::size_t bootstrap_draws = 1000;
/// Largest number of units for cross-validation (sysid/evidence/units.h). One fit is needed per unit. If
/// there are more runs than units, a unit contains several runs.
inline constexpr std::size_t most_units = 6;
/// Number of candidates that each stage of a search passes to the next stage. Each candidate requires one
/// fit.
inline constexpr std::size_t finalists = 5;
/// Number of start points from which the fit of each candidate is continued. If the first start point leads
/// only to a local minimum, the second one may lead to a better fit.
inline constexpr std::size_t followed_starts = 2;
/// Number of start points of a fit that repeats an earlier search or that only needs an approximate result. A
/// complete search uses more start points.
inline constexpr std::size_t repeated_starts = 6;
/// Largest number of alternatives that are examined or listed for one cause. A user is not expected to test
/// more alternatives.
inline constexpr std::size_t most_alternatives = 4;
/// Smallest number of events in a test at the level 1 - probability (5 %), because one exception in 20 events
/// corresponds to 5 %. Events are jumps, intervals, samples or simulations.
inline constexpr std::size_t fewest_events = 20;
/// Smallest number of occurrences on which a decision is based, for example the number of bins in which the
/// condition of a cause is met. With fewer occurrences, single noisy samples could determine the decision.
inline constexpr std::size_t fewest_occurrences = 5;

/// Smallest number of readings from which a cause can be separated from noise.
inline constexpr std::size_t fewest_readings = 200;

/// Smallest number of values from which a correlation coefficient is estimated. With 15 values and no
/// correlation, its standard error is 0.27.
inline constexpr std::size_t fewest_for_correlation = 15;

// Shares of an error

/// Relative improvement of an error or of the noise variance that counts as negligible, even if it is
/// statistically significant. No noise is known more accurately than to 1 %.
inline constexpr double negligible_share = 0.01;
/// Share of an error that may remain after a fit because a cause or a model has approximate equations.
/// Published models of soft fingers leave a few percent of the error.
inline constexpr double form_error_share = 0.05;
/// Largest relative difference between the errors of two hypotheses for which the simpler hypothesis is
/// preferred.
inline constexpr double equal_error_share = 0.1;
/// Largest ratio of two quantities that still count as comparable: of the error of a candidate to the
/// smallest error, and of a distance between command and pressure to the largest healthy one.
inline constexpr double comparable_ratio = 1.25;
/// An input is unfamiliar if it increases the permitted mean square error by more than this factor.
inline constexpr double unfamiliar_factor = 1 + equal_error_share;
/// Smallest share of the remaining error that a hypothesis must explain; below this share, it does not count
/// as an explanation.
inline constexpr double least_explained_share = 0.2;
/// Smallest share of the mean square that further parameters must explain if they only refine the equation of
/// a cause. They are not reported as a cause, so the limit is lower than `least_explained_share`.
inline constexpr double least_refinement_share = 0.02;
/// Smallest share that counts as the larger part of a quantity, for example of an error that a hypothesis
/// explains.
inline constexpr double majority_share = 0.5;

// Multiples of the noise of the readings

/// Error, as a multiple of the noise, below which the error cannot be seen in the readings.
inline constexpr double hidden_by_noise = 0.25;
/// Error, as a multiple of the noise, below which no further search is made. It can be seen in the readings,
/// but it increases the mean square error by at most a quarter of the noise variance.
inline constexpr double tolerated_noise = 0.5;

// Physical tolerances

/// Number of quantities in which repeated runs of a finger differ independently. They are the zero offset,
/// the gain, and the creep that remains from the previous run.
inline constexpr double run_directions = 3;
/// Standard deviation of the gain of a finger between runs without a change, as a share of the gain. It is
/// used if there are too few healthy runs to measure the variation.
inline constexpr double usual_gain_spread = 0.01;
/// Number of further runs that count as much as `usual_gain_spread` if the spread of the gain is estimated.
/// The spread that four healthy runs measure (3 degrees of freedom) then has the same weight as the usual
/// spread.
inline constexpr double usual_gain_runs = 3;
/// Length of the blocks that the bootstrap resamples, in units of time_unit_s(). A block lasts longer than
/// the fast part of the creep.
inline constexpr double block_in_units = 5;
/// Largest pressure above the lowest pressure that counts as zero, as a share of the pressure range. The
/// resolution of a valve near zero has about this size.
inline constexpr double rest_share = 0.05;
/// Largest change of a command that counts as constant, as a share of the full pressure.
inline constexpr double constant_command_share = 0.02;
/// Sampling interval of the records in a search, in units of time_unit_s(). The lags of valves and the
/// periods of the resonances of fingers are longer than this interval.
inline constexpr double search_interval_in_units = 0.02;
/// Sampling interval that is sufficient for a finger whose input is its measured pressure, in units of
/// time_unit_s(). The interval can be longer than `search_interval_in_units`, because a finger responds more
/// slowly than a valve.
inline constexpr double finger_interval_in_units = 0.05;
/// Largest noise of a command that counts as planned before the run, as a share of the standard deviation of
/// the command. The only noise of a planned command is the rounding in its file. The command of a controller
/// also contains the noise of the readings.
inline constexpr double planned_roughness = 1e-4;
/// A correlation coefficient with a larger magnitude counts as significant for the direction of a relation.
inline constexpr double clear_correlation = 0.5;
/// Largest phase_ratio() for which a cross-correlation counts as even. Up to this limit, the phase shift
/// differs by at most 30 degrees from 0 or 180 degrees.
inline constexpr double even_phase_ratio = 1.0 / 3;

}  // namespace softgrip::sysid::limits
