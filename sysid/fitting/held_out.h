#pragma once
// Held-out evidence: models are refitted without some blocks of the readings and judged there. The hidden
// state is always simulated from the start of the record, never corrected by readings.

#include <functional>
#include <vector>

#include "sysid/fitting/fit_space.h"
#include "sysid/fitting/paired_losses.h"
#include "sysid/logs/division.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// A fit to records of which some readings are hidden; called for several folds at once.
using Refit = std::function<FitPoint(const std::vector<Record>& rest)>;

/// Mean square of a residual over a block; of a block without readings 0 [mm^2].
[[nodiscard]] double loss_of(const std::vector<double>& residual_mm, const Block& block);

/// What every block loses under the model that `refit` finds without the block's fold. One that runs off
/// where it was not fitted loses no more than one that predicts nothing, the square of its record's span:
/// a larger loss would dominate every mean.
[[nodiscard]] BlockLosses held_out_losses(const std::vector<Record>& records, const Division& division,
                                          const Refit& refit);

}  // namespace softgrip::sysid
