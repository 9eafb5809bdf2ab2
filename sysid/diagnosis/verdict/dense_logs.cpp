#include "sysid/diagnosis/verdict/dense_logs.h"

#include <utility>

#include "base/numbers.h"

#include "sysid/logs/resampled_record.h"

namespace softgrip::sysid {

bool average_dense(std::vector<Record>& records, std::vector<std::string>& warnings) {
  std::size_t readings = 0;
  for (const Record& record : records) readings += record.readings;
  if (readings <= enough_readings) return false;
  bool any = false;
  for (Record& record : records) {
    Record averaged = averaged_to(record, averaged_interval_s);
    if (averaged.size() == record.size()) continue;
    warnings.push_back(record.name + ": " + significant(1 / record.mean_interval_s(), 3) +
                       " samples per second are more than the bandwidth of a finger requires, so the "
                       "diagnosis uses means over " +
                       significant(1e3 * averaged.mean_interval_s(), 2) +
                       " ms. The reported noise and errors are those of these means");
    record = std::move(averaged);
    any = true;
  }
  return any;
}

}  // namespace softgrip::sysid
