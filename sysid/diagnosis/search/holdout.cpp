#include "sysid/diagnosis/search/holdout.h"

namespace softgrip::sysid {
namespace {

/// The state in which a log begins is no part of the model's structure: without the first block it could not
/// be told, and the rest would be simulated from anywhere.
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

}  // namespace softgrip::sysid
