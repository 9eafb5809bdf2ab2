#pragma once
// Computes the error reductions that a search finds in data without a change. From these, it derives the
// reduction that a cause must exceed to be reported.

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace softgrip::sysid {

/// Error reduction per row (residual) by each cause, in a unit that was left out of the fit. The key is the
/// id of the cause.
using NullGains = std::map<std::string, double, std::less<>>;

/// Returns the largest expected value of a ratio. The numerator is the squared error on a further run. The
/// denominator is the mean of the squared errors on n runs, each predicted by a fit to the other n - 1 runs.
/// Both errors are differences from a mean: the first from a mean of n runs, the second from a mean of n - 1
/// runs. In each of the limits::run_directions directions, n runs have n - 1 independent differences. The
/// ratio is therefore (1 - 1/n^2) F, where F has run_directions and run_directions (n - 1) degrees of
/// freedom. The factor is 9.3 for one run, 7.0 for two runs, 4.2 for three and 3.2 for six. If there is one
/// run, its two halves are used in place of runs. The RMS error of another run may then be three times as
/// large.
[[nodiscard]] double run_to_run_factor(std::size_t runs);

class Tolerance {
 public:
  Tolerance() = default;
  /// @param units  error reductions in each unit; at least one unit. @param runs  number of runs in all units
  /// together.
  /// @param more  increase of the expected loss per row because of an unfamiliar input.
  Tolerance(const std::vector<NullGains>& units, std::size_t runs, double more = 0);

  /// Returns the mean error reduction by a cause in units without a change, >= 0.
  [[nodiscard]] double usual(std::string_view cause) const;
  /// Returns the error reduction per row above which a cause counts as a change. It is run_to_run_factor()
  /// times the larger of two values: the mean reduction by this cause, and the mean reduction by all causes.
  [[nodiscard]] double of(std::string_view cause) const;

 private:
  NullGains usual_;
  double average_ = 0, factor_ = 1, more_ = 0;
};

}  // namespace softgrip::sysid
