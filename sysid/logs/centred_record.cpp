#include "sysid/logs/centred_record.h"

#include <cmath>

namespace softgrip::sysid {
namespace {

/// Durations that differ by rounding alone are the same, and share their coefficients.
double without_rounding(double duration_s) {
  return std::round(duration_s * 1e9) * 1e-9;
}

std::vector<std::size_t> nearest_to_centres(const Record& record, double interval_s) {
  const auto intervals = [&](std::size_t i) {
    return (record.time_s[i] - record.time_s.front()) / interval_s + 1e-9;
  };
  const auto off_centre = [&](std::size_t i) {
    return std::abs(intervals(i) - std::floor(intervals(i)) - 0.5);
  };
  std::vector<std::size_t> kept{0};
  for (std::size_t i = 1; i < record.size(); ++i) {
    const bool another = kept.size() == 1 || std::floor(intervals(i)) > std::floor(intervals(kept.back()));
    if (another)
      kept.push_back(i);
    else if (off_centre(i) < off_centre(kept.back()))
      kept.back() = i;
  }
  return kept;
}

void pick(std::vector<double>& column, const std::vector<std::size_t>& kept) {
  if (column.empty()) return;
  for (std::size_t to = 0; to < kept.size(); ++to) column[to] = column[kept[to]];
  column.resize(kept.size());
}

}  // namespace

Record thinned_to_centres(const Record& record, double interval_s) {
  if (interval_s <= record.mean_interval_s()) return record;
  const std::vector<std::size_t> kept = nearest_to_centres(record, interval_s);
  Record thin = record;
  for (auto* column :
       {&thin.time_s, &thin.drive_kpa, &thin.reading_mm, &thin.temperature_c, &thin.supply_kpa})
    pick(*column, kept);
  thin.duration_s.assign(kept.size(), 0);
  thin.sample_time_s = 0;
  thin.readings = 0;
  for (std::size_t i = 0; i < thin.size(); ++i) {
    if (i > 0) thin.duration_s[i] = without_rounding(thin.time_s[i] - thin.time_s[i - 1]);
    if (std::isfinite(thin.reading_mm[i])) ++thin.readings;
  }
  return thin;
}

}  // namespace softgrip::sysid
