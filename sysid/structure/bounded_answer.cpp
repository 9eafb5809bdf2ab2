#include "sysid/structure/bounded_answer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sysid/fitting/trajectory.h"

namespace softgrip::sysid {
namespace {

void repeat(std::vector<double>& column) {
  const auto size = static_cast<std::ptrdiff_t>(column.size());
  column.resize(2 * column.size());
  std::copy_n(column.begin(), size, column.begin() + size);
}

Record twice(Record record) {
  const std::size_t size = record.size();
  const double interval_s = record.mean_interval_s(), length_s = record.length_s() + interval_s;
  for (auto* column : {&record.time_s, &record.duration_s, &record.drive_kpa, &record.reading_mm,
                       &record.temperature_c, &record.supply_kpa})
    repeat(*column);
  record.duration_s[size] = step_duration_s(interval_s);
  for (std::size_t i = size; i < record.size(); ++i) record.time_s[i] += length_s;
  return record;
}

bool stays_bounded(const model::Model& model, const Record& record, const StartState& start) {
  double lowest_mm = std::numeric_limits<double>::infinity(), highest_mm = -lowest_mm;
  for (const double reading_mm : record.reading_mm) {
    if (!std::isfinite(reading_mm)) continue;
    lowest_mm = std::min(lowest_mm, reading_mm);
    highest_mm = std::max(highest_mm, reading_mm);
  }
  const double width_mm = highest_mm - lowest_mm;
  const std::vector<double> answer_mm = predict(model, twice(record), start);
  return std::all_of(answer_mm.begin(), answer_mm.end(),
                     [&](double y) { return y >= lowest_mm - width_mm && y <= highest_mm + width_mm; });
}

}  // namespace

bool stays_bounded(const FitPoint& point, const std::vector<Record>& records) {
  for (std::size_t r = 0; r < records.size(); ++r) {
    if (!stays_bounded(point.model, records[r], point.starts[r])) return false;
  }
  return true;
}

}  // namespace softgrip::sysid
