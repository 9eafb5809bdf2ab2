#pragma once
// Fits a filter bank to the residuals of models. It is evaluated on units that are left out in turn.

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "sysid/changes/bins.h"
#include "sysid/changes/filter_bank.h"
#include "sysid/evidence/comparison.h"
#include "sysid/evidence/units.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// A filter bank with the weights of the best ridge.
struct FittedFilters {
  Eigen::VectorXd weights;  ///< one per column of filter_columns(); empty if the model alone predicts as well
  Binned left;              ///< residual of each left-out unit; NaN: no reading
  double left_mm = 0;       ///< root of its mean square about the mean of each unit
};

/// Returns the squares of two residuals over blocks of some seconds, each about its mean in every unit.
[[nodiscard]] PairedLosses losses_of(const Binned& worse, const Binned& better, const Units& units,
                                     double bin_s);

/// Residuals of a model for all records, in bins: fitted without each unit in turn, then fitted to all units.
using LeftByUnit = std::vector<Binned>;

/// Fits one filter bank for each model. All models have the same drives, so that they share columns and
/// factors. A model with a prediction that is not finite has an infinite left_mm.
/// @param left  by model. @param largest_kpa  of all records.
[[nodiscard]] std::vector<FittedFilters> fit_filters(const std::vector<Record>& records, const Units& units,
                                                     FilterKind kind, double bin_s, double largest_kpa,
                                                     const std::vector<LeftByUnit>& left, std::uint64_t seed);

}  // namespace softgrip::sysid
