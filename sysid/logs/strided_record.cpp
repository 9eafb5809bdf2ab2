#include "sysid/logs/strided_record.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace softgrip::sysid {
namespace {

/// From so much of the largest command on a command that leaves the straight line between two samples jumps.
constexpr double least_jump = 0.01;

/// The command at sample `at`, weighted by a hat over the samples that are dropped on either side.
double hat_mean_kpa(const std::vector<double>& drive_kpa, std::size_t at, std::size_t stride) {
  const double width = static_cast<double>(stride);
  double sum_kpa = drive_kpa[at];
  for (std::size_t j = 1; j < stride; ++j)
    sum_kpa += (1 - static_cast<double>(j) / width) * (drive_kpa[at - j] + drive_kpa[at + j]);
  return sum_kpa / width;
}

/// Whether the command jumps between sample `at` and the next one that is kept.
bool jumps_after(const Record& record, std::size_t at, std::size_t stride) {
  const double from_kpa = record.drive_kpa[at], to_kpa = record.drive_kpa[at + stride];
  for (std::size_t j = 1; j < stride; ++j) {
    const double share = static_cast<double>(j) / static_cast<double>(stride);
    const double straight_kpa = from_kpa + share * (to_kpa - from_kpa);
    if (std::abs(record.drive_kpa[at + j] - straight_kpa) > least_jump * record.largest_kpa) return true;
  }
  return false;
}

/// A jump between two samples that are kept would come up to a whole interval early or late: there the
/// command keeps its mean instead of its value. Corners without a jump stay as sharp as they are.
void keep_mean_of_jumps(const Record& record, std::size_t stride, Record& thin) {
  if (record.held) {
    for (std::size_t to = 0; to + 1 < thin.size(); ++to) {
      const auto first = record.drive_kpa.begin() + static_cast<long>(to * stride);
      thin.drive_kpa[to] =
          std::accumulate(first, first + static_cast<long>(stride), 0.0) / static_cast<double>(stride);
    }
    return;
  }
  bool jumped = false;
  for (std::size_t to = 1; (to + 1) * stride < record.size(); ++to) {
    const bool jumps = jumps_after(record, to * stride, stride);
    if (jumps || jumped) thin.drive_kpa[to] = hat_mean_kpa(record.drive_kpa, to * stride, stride);
    jumped = jumps;
  }
}

std::size_t stride_for(const Record& record, double interval_s) {
  return static_cast<std::size_t>(std::max(1.0, std::floor(interval_s / record.mean_interval_s())));
}

/// Mean of `reach` readings on either side of one and itself; none where fewer than half are there.
double mean_around(const std::vector<double>& readings, std::size_t at, std::size_t reach) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = at - reach; i <= at + reach; ++i) {
    if (!std::isfinite(readings[i])) continue;
    sum += readings[i];
    ++count;
  }
  return 2 * count > 2 * reach ? sum / static_cast<double>(count) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

Record thinned_record(const Record& record, std::size_t stride) {
  std::vector<std::size_t> kept;
  kept.reserve(record.size() / stride + 1);
  for (std::size_t i = 0; i < record.size(); i += stride) kept.push_back(i);
  Record thin = thinned_record(record, kept);
  thin.sample_time_s = record.sample_time_s * static_cast<double>(stride);
  if (stride > 1) keep_mean_of_jumps(record, stride, thin);
  return thin;
}

Record thinned_to(const Record& record, double interval_s) {
  const std::size_t stride = stride_for(record, interval_s);
  return stride > 1 ? thinned_record(record, stride) : record;
}

Record averaged_to(const Record& record, double interval_s) {
  const std::size_t stride = stride_for(record, interval_s);
  if (stride <= 1) return record;
  Record thin = thinned_record(record, stride);
  thin.finest_interval_s = thin.mean_interval_s();
  thin.readings = 0;
  for (std::size_t to = 0; to < thin.size(); ++to) {
    const std::size_t at = to * stride;
    const std::size_t reach = std::min({(stride - 1) / 2, at, record.size() - 1 - at});
    thin.reading_mm[to] = mean_around(record.reading_mm, at, reach);
    if (std::isfinite(thin.reading_mm[to])) ++thin.readings;
  }
  return thin;
}

}  // namespace softgrip::sysid
