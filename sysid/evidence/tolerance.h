#pragma once
// What a search finds where nothing has changed, and what it must find beyond that.

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace softgrip::sysid {

/// Of one unit that was predicted without having been fitted: what each cause improves there, per row.
using NullGains = std::map<std::string, double, std::less<>>;

/// How much more the squared error of another run may be than its mean over n runs, each predicted by the
/// others. Both errors are differences from a mean, of n and of n - 1 runs. In each of
/// limits::run_directions, n runs have n - 1 differences. The ratio is therefore (1 - 1/n^2) F, with F
/// distributed for run_directions and run_directions (n - 1) degrees of freedom. The factor is 9.3 for one
/// run (three times in root mean square, whose halves replace the runs), 7.0 for two, 4.2 for three and 3.2
/// for six.
[[nodiscard]] double run_to_run_factor(std::size_t runs);

class Tolerance {
 public:
  Tolerance() = default;
  /// @param units  one at least. @param runs  how many runs they come from.
  Tolerance(const std::vector<NullGains>& units, std::size_t runs);

  /// What a cause improves in unchanged units: the mean over the units, 0 at least.
  [[nodiscard]] double usual(std::string_view cause) const;
  /// What it must improve to count as a change, per row: the run-to-run factor times its own usual
  /// improvement, or times that of the average cause where that is more.
  [[nodiscard]] double of(std::string_view cause) const;

 private:
  NullGains usual_;
  double average_ = 0, factor_ = 1;
};

}  // namespace softgrip::sysid
