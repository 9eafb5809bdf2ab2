#include "sysid/logs/finer_record.h"

#include <limits>

namespace softgrip::sysid {
namespace {

/// What stands between a value and the next one, `share` of the way there.
template <class Between>
std::vector<double> finer(const std::vector<double>& series, std::size_t parts, Between&& between) {
  std::vector<double> out;
  if (series.empty()) return out;
  out.reserve((series.size() - 1) * parts + 1);
  out.push_back(series.front());
  for (std::size_t i = 1; i < series.size(); ++i) {
    for (std::size_t k = 1; k < parts; ++k)
      out.push_back(between(series[i - 1], series[i], static_cast<double>(k) / static_cast<double>(parts)));
    out.push_back(series[i]);
  }
  return out;
}

}  // namespace

Record finer_record(const Record& record, std::size_t parts) {
  const auto straight = [](double from, double to, double share) { return from + share * (to - from); };
  const auto held = [](double from, double, double) { return from; };
  const auto unknown = [](double, double, double) { return std::numeric_limits<double>::quiet_NaN(); };
  Record fine = record;
  fine.time_s = finer(record.time_s, parts, straight);
  fine.drive_kpa =
      record.held ? finer(record.drive_kpa, parts, held) : finer(record.drive_kpa, parts, straight);
  fine.reading_mm = finer(record.reading_mm, parts, unknown);
  fine.temperature_c = finer(record.temperature_c, parts, straight);
  fine.supply_kpa = finer(record.supply_kpa, parts, straight);
  fine.duration_s.assign(fine.time_s.size(), record.duration_s.front());
  for (std::size_t i = 1; i < fine.time_s.size(); ++i)
    fine.duration_s[i] = record.duration_s[(i - 1) / parts + 1] / static_cast<double>(parts);
  fine.sample_time_s = record.sample_time_s / static_cast<double>(parts);
  return fine;
}

}  // namespace softgrip::sysid
