#pragma once
// Compares two hypotheses by their losses on the same data, and computes the tolerance of a search for
// changes from the error reductions that the search finds in data without a change. A cause is reported only
// if its error reduction exceeds the tolerance. The bootstrap of sysid/fitting/held_out.h draws blocks
// instead.

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "sysid/fitting/interval.h"

namespace softgrip::sysid {

/// Losses of two hypotheses, stated separately for each block of the data.
struct PairedLosses {
  std::vector<double> worse, better;  ///< sum of squared residuals of each hypothesis in each block
  std::vector<double> rows;           ///< number of rows (residuals) in each block

  /// Begins a further block, which has no rows yet.
  void begin_block();
  /// Adds a row to the block that was begun last.
  /// @param residual_of_worse, residual_of_better  residuals of the two hypotheses in this row.
  void add(double residual_of_worse, double residual_of_better);
  /// Appends the blocks of other data.
  void append(const PairedLosses& more);
};

struct Comparison {
  /// Share of the bootstrap samples in which the loss of `worse` exceeds the loss of `better` by more than
  /// the tolerance.
  double share = 0;
  double lower = 0, upper = 0;  ///< 95 % interval of the loss difference (`worse` minus `better`) per row
};

/// Compares the mean losses per row of two hypotheses by a Bayesian bootstrap over the blocks (Rubin, Annals
/// of Statistics 9, 1981). Each bootstrap sample weights the blocks randomly.
/// @param tolerance  largest loss difference per row that counts as zero.
/// @param seed  seed of the random weights; equal seeds give equal results.
[[nodiscard]] Comparison compare(const PairedLosses& losses, double tolerance, std::uint64_t seed);

/// Reduction of the root of the loss, 1 - sqrt(better / worse), with its 95 % interval.
struct ErrorReduction {
  double share = 0;
  Interval interval;
};

/// Returns the reduction from the loss of `worse` to the loss of `better`, with the bootstrap samples of
/// compare(). The ratio is computed in each sample. If the loss of `worse` is 0, the reduction is 0.
[[nodiscard]] ErrorReduction error_reduction(const PairedLosses& losses, std::uint64_t seed);

/// Returns true if `better` wins in at least 95 % of the bootstrap samples (limits::probability). It wins in
/// a sample if its loss is smaller by more than the tolerance of compare().
[[nodiscard]] bool is_better(const Comparison& comparison);

/// Error reduction per row (residual) by each cause, in a healthy run that was left out of the fit. The key
/// is the id of the cause.
using NullGains = std::map<std::string, double, std::less<>>;

/// Returns the 95 % quantile of an error ratio. The numerator is the squared error on a further run. The
/// denominator is the mean squared error on n runs, each of which is predicted by a fit to the other n - 1
/// runs. Both errors are differences from a mean. The mean has n runs in the numerator and n - 1 runs in the
/// denominator. Runs differ in d = limits::run_directions independent directions. The ratio is (1 - 1/n^2) F,
/// where F has d and d (n - 1) degrees of freedom. The result is 9.3 for one run, 7.0 for two runs, 4.2 for
/// three runs and 3.2 for six runs. If there is one run, its two halves replace the runs. The RMS error of a
/// further run may then be three times as large as the error between the halves.
[[nodiscard]] double run_to_run_factor(std::size_t runs);

class Tolerance {
 public:
  Tolerance() = default;
  /// @param units  error reductions in each cross-validation unit; at least one unit.
  /// @param runs  number of runs that all units contain together.
  /// @param more  amount by which an unfamiliar input increases the expected loss per row.
  Tolerance(const std::vector<NullGains>& units, std::size_t runs, double more = 0);

  /// Returns the mean error reduction by a cause in data without a change. Negative reductions count as 0.
  /// For a cause that the units do not contain, returns the mean over all causes.
  [[nodiscard]] double usual(std::string_view cause) const;
  /// Returns the error reduction per row above which a cause counts as a change. The threshold is
  /// run_to_run_factor() times a sum. The sum consists of the increase `more` and the larger one of two
  /// values: the mean reduction by this cause, and the mean reduction over all causes.
  [[nodiscard]] double of(std::string_view cause) const;

 private:
  NullGains usual_;
  double average_ = 0, factor_ = 1, more_ = 0;
};

}  // namespace softgrip::sysid
