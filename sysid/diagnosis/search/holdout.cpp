#include "sysid/diagnosis/search/holdout.h"

#include <algorithm>

#include "sysid/fitting/start_estimate.h"

namespace softgrip::sysid {
namespace {

/// Effort of the refits. They keep the initial states of the logs, which are not part of the model structure.
/// If the first block of a log is held out, its initial state would otherwise be undetermined, and the
/// simulation of the other blocks would start at an arbitrary state.
constexpr FitEffort refit{.most_iterations = 8, .tolerance = 1e-6, .hold_starts = true};

}  // namespace

BlockLosses losses_of(const StructureFit& fit, const Division& division) {
  BlockLosses losses;
  for (const Block& block : division.blocks) losses.push_back(loss_of(fit.residual_mm[block.record], block));
  return losses;
}

BlockLosses held_out_losses(const std::vector<Record>& records, const Division& division,
                            const StructureFit& fit) {
  return held_out_losses(records, division, [&](const std::vector<Record>& rest) {
    return fit_structure(rest, fit.causes, fit.point, refit).point;
  });
}

BlockLosses left_out_losses(const std::vector<Record>& records, const Division& by_unit,
                            const StructureFit& fit) {
  return held_out_losses(records, by_unit, [&](const std::vector<Record>& rest) {
    // If only the unit that is left out contains readings, no fit is possible.
    const bool is_fitted =
        std::any_of(rest.begin(), rest.end(), [](const Record& r) { return r.readings > 0; });
    FitPoint point = is_fitted ? fit_structure(rest, fit.causes, fit.point, refit).point : fit.point;
    for (std::size_t k = 0; k < rest.size(); ++k) {
      if (rest[k].readings == 0) point.starts[k] = estimated_start(point.model, records[k]);
    }
    return point;
  });
}

}  // namespace softgrip::sysid
