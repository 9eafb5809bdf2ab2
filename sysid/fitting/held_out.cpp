#include "sysid/fitting/held_out.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/logs/each_record.h"

namespace softgrip::sysid {

double loss_of(const std::vector<double>& residual_mm, const Block& block) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = block.first; i < block.last; ++i) {
    if (std::isnan(residual_mm[i])) continue;
    sum += residual_mm[i] * residual_mm[i];
    ++count;
  }
  return count == 0 ? 0 : sum / static_cast<double>(count);
}

BlockLosses held_out_losses(const std::vector<Record>& records, const Division& division,
                            const Refit& refit) {
  BlockLosses losses(division.blocks.size(), 0.0);
  parallel_for_idle(division.folds, [&](std::size_t fold) {
    const FitPoint point = refit(without_fold(records, division, fold));
    std::vector<std::vector<double>> residual_mm(records.size());
    for_each_record(records, [&](std::size_t k) {
      residual_mm[k] = residual(records[k], predict(point.model, records[k], point.starts[k]));
    });
    for (std::size_t b = 0; b < losses.size(); ++b) {
      const Block& block = division.blocks[b];
      if (block.fold != fold) continue;
      const double span_mm = records[block.record].span_mm;
      losses[b] = std::min(loss_of(residual_mm[block.record], block), span_mm * span_mm);
    }
  });
  return losses;
}

}  // namespace softgrip::sysid
