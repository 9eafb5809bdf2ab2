#include "sysid/diagnosis/verdict/run_errors.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace softgrip::sysid {

std::vector<RunError> run_errors(const std::vector<Record>& records, const Division& by_unit,
                                 const BlockLosses& given, const BlockLosses& recalibrated,
                                 const BlockLosses& extended) {
  const bool are_runs = records.size() > 1;
  std::vector<RunError> runs(are_runs ? records.size() : by_unit.folds);
  for (std::size_t k = 0; k < runs.size(); ++k) {
    runs[k].run = are_runs ? records[k].name : k == 0 ? "first half" : "second half";
    BlockLosses own_given, own_recalibrated, own_extended;
    for (std::size_t b = 0; b < by_unit.blocks.size(); ++b) {
      const Block& block = by_unit.blocks[b];
      const auto readings = records[block.record].reading_mm.begin();
      const auto begin = readings + static_cast<std::ptrdiff_t>(block.first);
      const auto end = readings + static_cast<std::ptrdiff_t>(block.last);
      if ((are_runs ? block.record : block.fold) != k ||
          std::none_of(begin, end, [](double y) { return std::isfinite(y); }))
        continue;
      own_given.push_back(given[b]);
      own_recalibrated.push_back(recalibrated[b]);
      own_extended.push_back(extended[b]);
    }
    runs[k].given = rmse_mm(own_given);
    runs[k].recalibrated = rmse_mm(own_recalibrated);
    runs[k].extended = rmse_mm(own_extended);
  }
  return runs;
}

}  // namespace softgrip::sysid
