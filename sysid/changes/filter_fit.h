#pragma once
// Fits a filter bank to the residuals of models and evaluates it on units that are left out in turn
// (sysid/evidence/units.h).

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "sysid/changes/bins.h"
#include "sysid/changes/filter_bank.h"
#include "sysid/evidence/comparison.h"
#include "sysid/evidence/units.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Weights of a filter bank, fitted with the best ridge regularisation.
struct FittedFilters {
  Eigen::VectorXd weights;  ///< one weight per column of filter_columns(); empty if the filter bank does not
                            ///< improve the prediction
  Binned left;              ///< residual of each unit under a fit without this unit; NaN: no reading
  double left_mm = 0;       ///< root mean square of `left` about the mean of each unit
};

/// Returns the squares of two residuals over blocks of some seconds, after subtraction of the mean of each
/// unit.
[[nodiscard]] PairedLosses losses_of(const Binned& worse, const Binned& better, const Units& units,
                                     double bin_s);

/// Residuals of a model for all records, in bins: one element per unit that was left out of the fit, and a
/// last element for the fit to all units.
using LeftByUnit = std::vector<Binned>;

/// Fits one filter bank for each model. All models must have the same input, so that they share the columns
/// and their factorisations. A model whose prediction is not finite gets an infinite left_mm.
/// @param left  residuals of each model.
/// @param largest_kpa  largest pressure of all records.
[[nodiscard]] std::vector<FittedFilters> fit_filters(const std::vector<Record>& records, const Units& units,
                                                     FilterKind kind, double bin_s, double largest_kpa,
                                                     const std::vector<LeftByUnit>& left, std::uint64_t seed);

}  // namespace softgrip::sysid
