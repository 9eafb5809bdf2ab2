#pragma once
// Fits a filter bank to the residuals of models and evaluates it by cross-validation: each unit
// (sysid/evidence/units.h) is left out of one fit.

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "sysid/changes/bins.h"
#include "sysid/changes/filter_bank.h"
#include "sysid/evidence/comparison.h"
#include "sysid/evidence/units.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Weights of a filter bank. The ridge parameter of the fit is the one with the smallest error in left-out
/// units.
struct FittedFilters {
  /// One weight per column of filter_columns(); empty if the filter bank does not improve the prediction.
  Eigen::VectorXd weights;
  Binned left;         ///< residual of each unit, predicted by a fit to the other units; NaN: no reading
  double left_mm = 0;  ///< root mean square of `left` after subtraction of the mean of each unit
};

/// Returns the sums of squares of two residuals in blocks of some seconds. Before, the mean of each unit is
/// subtracted.
[[nodiscard]] PairedLosses losses_of(const Binned& worse, const Binned& better, const Units& units,
                                     double bin_s);

/// Residuals of a model for all records in bins. Element i belongs to the fit without unit i, and the last
/// element belongs to the fit to all units.
using LeftByUnit = std::vector<Binned>;

/// Fits one filter bank for each model. All models must have the same input, so that their columns and
/// factorisations are equal. If the prediction of a model is not finite, its left_mm is infinite.
/// @param left  residuals of each model.
/// @param largest_kpa  largest pressure of all records.
[[nodiscard]] std::vector<FittedFilters> fit_filters(const std::vector<Record>& records, const Units& units,
                                                     FilterKind kind, double bin_s, double largest_kpa,
                                                     const std::vector<LeftByUnit>& left, std::uint64_t seed);

}  // namespace softgrip::sysid
