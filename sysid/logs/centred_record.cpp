#include "sysid/logs/centred_record.h"

#include <cmath>

namespace softgrip::sysid {
namespace {

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

}  // namespace

Record thinned_to_centres(const Record& record, double interval_s) {
  if (interval_s <= record.mean_interval_s()) return record;
  Record thin = thinned_record(record, nearest_to_centres(record, interval_s));
  thin.finest_interval_s = thin.mean_interval_s();
  return thin;
}

}  // namespace softgrip::sysid
