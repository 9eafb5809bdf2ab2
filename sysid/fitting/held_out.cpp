#include "sysid/fitting/held_out.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/statistics.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/logs/each_record.h"

namespace softgrip::sysid {
namespace {

bool is_finite_where_read(const Record& record, const std::vector<double>& residual_mm, const Block& block) {
  for (std::size_t i = block.first; i < block.last; ++i) {
    if (std::isfinite(record.reading_mm[i]) && !std::isfinite(residual_mm[i])) return false;
  }
  return true;
}

}  // namespace

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
      const double most = square(records[block.record].span_mm);
      const bool is_predicted = is_finite_where_read(records[block.record], residual_mm[block.record], block);
      losses[b] = is_predicted ? std::min(loss_of(residual_mm[block.record], block), most) : most;
    }
  });
  return losses;
}

}  // namespace softgrip::sysid
