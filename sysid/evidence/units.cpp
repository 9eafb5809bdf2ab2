#include "sysid/evidence/units.h"

#include <algorithm>

#include "sysid/limits/limits.h"
#include "sysid/logs/division.h"

namespace softgrip::sysid {

Units::Units(const std::vector<Record>& records) : block_s_(limits::block_in_units * time_unit_s(records)) {
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
    std::size_t middle = 0;
    while (middle < record.size() && unit_of(r, record.time_s[middle] - record.time_s.front()) == 0) ++middle;
    hide_readings(record, unit == 0 ? 0 : middle, unit == 0 ? middle : record.size());
  }
  return rest;
}

Division divide_by_unit(const std::vector<Record>& records) {
  const Units units(records);
  Division division = divide(records, units.block_s());
  division.folds = units.count();
  division.gap_s = 0;
  for (Block& block : division.blocks) {
    const std::vector<double>& time_s = records[block.record].time_s;
    block.fold = units.unit_of(block.record, time_s[block.first] - time_s.front());
    block.hidden_first = block.first;
    block.hidden_last = block.last;
  }
  return division;
}

}  // namespace softgrip::sysid
