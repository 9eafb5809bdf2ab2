#include "sysid/changes/drive_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sysid/changes/echo_fit.h"

namespace softgrip::sysid {
namespace {

/// Means of the bins whose middle is within each longer bin.
Binned in_longer_bins(const Binned& series, double from_s, double to_s, const Binned& shape) {
  Binned longer;
  for (std::size_t r = 0; r < series.size(); ++r) {
    std::vector<double> sum(shape[r].size(), 0), count(shape[r].size(), 0);
    for (std::size_t b = 0; b < series[r].size() && !sum.empty(); ++b) {
      if (!std::isfinite(series[r][b])) continue;
      const auto bin = static_cast<std::size_t>((static_cast<double>(b) + 0.5) * from_s / to_s);
      sum[std::min(bin, sum.size() - 1)] += series[r][b];
      count[std::min(bin, sum.size() - 1)] += 1;
    }
    for (std::size_t b = 0; b < sum.size(); ++b)
      sum[b] = count[b] > 0 ? sum[b] / count[b] : std::numeric_limits<double>::quiet_NaN();
    longer.push_back(std::move(sum));
  }
  return longer;
}

}  // namespace

bool command_predicts_better(const Base& by_command, const Base& by_pressure, std::uint64_t seed) {
  const Binned command =
      in_longer_bins(by_command.left, by_command.bin_s, by_pressure.bin_s, by_pressure.left);
  return is_better(
      compare(losses_of(by_pressure.left, command, by_pressure.units, by_pressure.bin_s), 0, seed));
}

}  // namespace softgrip::sysid
