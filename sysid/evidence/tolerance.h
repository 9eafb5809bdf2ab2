#pragma once
// Computes the error reduction that a search finds in data without a change, and the reduction that a cause
// must exceed to be reported.

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace softgrip::sysid {

/// Error reduction per row by each cause (by id) in one unit that was left out of the fit.
using NullGains = std::map<std::string, double, std::less<>>;

/// Returns the largest expected ratio of the squared error of another run to the mean squared error of n
/// runs, where each of the n runs is predicted by a fit to the others. Both errors are differences from a
/// mean, of n runs and of n - 1 runs. In each of the limits::run_directions directions, n runs have n - 1
/// differences. The ratio is therefore (1 - 1/n^2) F, where F has run_directions and run_directions (n - 1)
/// degrees of freedom. The factor is 9.3 for one run, 7.0 for two, 4.2 for three and 3.2 for six. With one
/// run, its two halves are used instead of runs, and the RMS error of another run may be three times as
/// large.
[[nodiscard]] double run_to_run_factor(std::size_t runs);

class Tolerance {
 public:
  Tolerance() = default;
  /// @param units  error reductions in the units, at least one unit. @param runs  number of runs that the
  /// units contain.
  Tolerance(const std::vector<NullGains>& units, std::size_t runs);

  /// Returns the mean error reduction by a cause in the unchanged units, >= 0.
  [[nodiscard]] double usual(std::string_view cause) const;
  /// Returns the error reduction per row that a cause must exceed to count as a change. It is the run-to-run
  /// factor times the larger of two values: the mean reduction by this cause, and the mean reduction by all
  /// causes.
  [[nodiscard]] double of(std::string_view cause) const;

 private:
  NullGains usual_;
  double average_ = 0, factor_ = 1;
};

}  // namespace softgrip::sysid
