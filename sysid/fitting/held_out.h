#pragma once
// Cross-validates models: each model is refitted without some blocks of the readings, and its error on these
// blocks is computed. The hidden state of a model is always simulated from the start of the record. Readings
// never correct this state.

#include <functional>
#include <vector>

#include "sysid/fitting/fit_space.h"
#include "sysid/fitting/paired_losses.h"
#include "sysid/logs/division.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Function that fits a model to records from which some readings were removed. The function is called for
/// several folds in parallel.
using Refit = std::function<FitPoint(const std::vector<Record>& rest)>;

/// Returns the mean square of a residual over a block [mm^2]; 0 for a block without readings.
[[nodiscard]] double loss_of(const std::vector<double>& residual_mm, const Block& block);

/// Returns the mean square error of each block [mm^2]. The prediction comes from the model that `refit`
/// returns for the records without the fold of this block. The error is at most the square of the record's
/// span, so that a single diverging prediction does not dominate the means.
[[nodiscard]] BlockLosses held_out_losses(const std::vector<Record>& records, const Division& division,
                                          const Refit& refit);

}  // namespace softgrip::sysid
