#include "sysid/evidence/units.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sysid/evidence/limits.h"

namespace softgrip::sysid {

double begin_s(const Record& record) noexcept {
  const double length_s = record.length_s();
  return std::min(0.5 * length_s, std::max(limits::begin_share * length_s, limits::least_begin_s));
}

Units::Units(const std::vector<Record>& records) {
  for (const Record& record : records) middle_s_.push_back(record.length_s() / 2);
  count_ = are_runs() ? std::min(runs(), limits::most_units) : 2;
}

std::size_t Units::unit_of(std::size_t record, double since_start_s) const noexcept {
  if (are_runs()) return record % count_;
  return since_start_s < middle_s_[record] ? 0 : 1;
}

std::vector<Record> Units::without(const std::vector<Record>& records, std::size_t unit,
                                   std::vector<std::size_t>* kept) const {
  std::vector<Record> rest;
  for (std::size_t r = 0; r < records.size(); ++r) {
    if (unit < count_ && are_runs() && unit_of(r, 0) == unit) continue;
    rest.push_back(records[r]);
    if (kept != nullptr) kept->push_back(r);
    if (unit >= count_ || are_runs()) continue;
    Record& record = rest.back();
    for (std::size_t i = 0; i < record.size(); ++i) {
      if (unit_of(r, record.time_s[i] - record.time_s.front()) != unit ||
          !std::isfinite(record.reading_mm[i]))
        continue;
      record.reading_mm[i] = std::numeric_limits<double>::quiet_NaN();
      record.readings -= 1;
    }
  }
  return rest;
}

}  // namespace softgrip::sysid
