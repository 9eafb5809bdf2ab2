#pragma once
// The improvement that a search finds without a change, and the improvement that it must exceed to report
// one.

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace softgrip::sysid {

/// Improvement per row that each cause reaches in one unit that was predicted but not fitted.
using NullGains = std::map<std::string, double, std::less<>>;

/// Returns the largest expected ratio of the squared error of another run to the mean squared error of n
/// runs, where each run is predicted from the others. Both errors are differences from a mean, of n and of n
/// - 1 runs. In each of limits::run_directions, n runs have n - 1 differences. The ratio is therefore (1 -
/// 1/n^2) F, where F has run_directions and run_directions (n - 1) degrees of freedom. The factor is 9.3 for
/// one run, 7.0 for two, 4.2 for three and 3.2 for six. For one run, its halves replace the runs, and the RMS
/// error may be three times as large.
[[nodiscard]] double run_to_run_factor(std::size_t runs);

class Tolerance {
 public:
  Tolerance() = default;
  /// @param units  at least one. @param runs  number of runs that the units come from.
  Tolerance(const std::vector<NullGains>& units, std::size_t runs);

  /// Returns the mean improvement of a cause over the unchanged units, >= 0.
  [[nodiscard]] double usual(std::string_view cause) const;
  /// Returns the improvement per row that a cause must exceed to count as a change. It is the run-to-run
  /// factor times its own mean improvement, or times the mean of all causes if that is larger.
  [[nodiscard]] double of(std::string_view cause) const;

 private:
  NullGains usual_;
  double average_ = 0, factor_ = 1;
};

}  // namespace softgrip::sysid
