#include "sysid/diagnosis/outliers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace softgrip::sysid {
namespace {

/// A reading against the median of its four neighbours has a deviation of about 1.15 of the noise; beyond
/// this many a normal one falls less than once in ten million.
constexpr double beyond = 6.0;
/// Fewer than that many could be anything.
constexpr std::size_t fewest = 5;

double neighbours_median(const std::vector<double>& y, std::size_t i) {
  std::array<double, 4> near{y[i - 2], y[i - 1], y[i + 1], y[i + 2]};
  std::sort(near.begin(), near.end());
  return 0.5 * (near[1] + near[2]);
}

/// Motion over the neighbourhood, so that a fast move is no outlier.
double motion(const std::vector<double>& y, std::size_t i) {
  return std::abs(0.5 * (y[i + 1] + y[i + 2]) - 0.5 * (y[i - 1] + y[i - 2]));
}

bool is_outlier(const std::vector<double>& y, std::size_t i, double noise_mm, double& size) {
  size = y[i] - neighbours_median(y, i);
  if (!std::isfinite(size)) return false;
  return std::abs(size) > beyond * noise_mm && std::abs(size) > 3 * motion(y, i);
}

}  // namespace

OutlierEvidence hide_outliers(std::vector<Record>& records, double noise_mm) {
  OutlierEvidence evidence;
  double square = 0, fourth = 0;
  for (Record& record : records) {
    const std::vector<double> y = record.reading_mm;
    evidence.readings += record.readings;
    for (std::size_t i = 2; i + 2 < y.size(); ++i) {
      double size = 0;
      if (!is_outlier(y, i, noise_mm, size)) continue;
      record.reading_mm[i] = std::numeric_limits<double>::quiet_NaN();
      --record.readings;
      ++evidence.count;
      square += size * size;
      fourth += size * size * size * size;
    }
  }
  if (evidence.count == 0) return evidence;
  const auto count = static_cast<double>(evidence.count);
  const auto all = static_cast<double>(evidence.readings);
  evidence.share = count / all;
  evidence.size_mm = std::sqrt(square / count);
  evidence.excess_mm = std::sqrt(square / all);
  const double z = 1.96;
  const double middle = (evidence.share + z * z / (2 * all)) / (1 + z * z / all);
  const double half = z / (1 + z * z / all) *
                      std::sqrt(evidence.share * (1 - evidence.share) / all + z * z / (4 * all * all));
  evidence.share_low = middle - half;
  evidence.share_high = middle + half;
  const double deviation = std::sqrt(std::max(0.0, fourth / count - square / count * square / count) / count);
  evidence.size_low_mm = std::sqrt(std::max(0.0, square / count - z * deviation));
  evidence.size_high_mm = std::sqrt(square / count + z * deviation);
  // At six deviations noise gives none; a handful may be a knock on the table.
  evidence.present = evidence.count >= fewest && evidence.excess_mm > 0.1 * noise_mm;
  return evidence;
}

}  // namespace softgrip::sysid
