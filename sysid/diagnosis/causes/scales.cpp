#include "sysid/diagnosis/causes/scales.h"

#include <algorithm>
#include <limits>

#include "sysid/logs/finite_values.h"

namespace softgrip::sysid {

Scales scales_of(const std::vector<Record>& records) {
  Scales s;
  s.sample_s = std::numeric_limits<double>::infinity();
  const CampaignSize size = campaign_size(records);
  s.span_mm = size.span_mm;
  s.largest_kpa = size.largest_kpa;
  if (!records.empty()) s.time_unit_s = time_unit_s(records);
  for (const Record& record : records) {
    s.campaign_s += record.length_s();
    s.step_mm = std::max(s.step_mm, record.step_mm);
    s.sample_s = std::min(s.sample_s, record.finest_interval_s);
    s.has_temperature |= varies(record.temperature_c);
    s.has_supply |= varies(record.supply_kpa);
    for (const double supply : record.supply_kpa)
      s.largest_supply_kpa = std::max(s.largest_supply_kpa, supply);
  }
  return s;
}

}  // namespace softgrip::sysid
