#pragma once
// Fits a filter bank to the residuals of models and evaluates the filter bank by cross-validation. Each fit
// leaves out one unit (sysid/evidence/units.h).

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "sysid/changes/bins.h"
#include "sysid/changes/filter_bank.h"
#include "sysid/evidence/comparison.h"
#include "sysid/evidence/units.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Weights of a filter bank, fitted with the ridge parameter that leads to the smallest error in the
/// cross-validation.
struct FittedFilters {
  /// One weight per column of filter_columns(); empty if the filter bank does not improve the prediction, or
  /// if there is only one run and the filter bank is not the only part of the model.
  Eigen::VectorXd weights;
  std::vector<Eigen::VectorXd> without;  ///< for each unit, the weights of the fit to all other units
  Binned left;         ///< residual of each cross-validation unit, predicted by a fit to all other units;
                       ///< NaN: no reading
  double left_mm = 0;  ///< root mean square of `left`; the mean of each unit is subtracted first
};

/// Returns the sums of squares of two residuals in blocks of some seconds. The mean of each cross-validation
/// unit is subtracted first.
[[nodiscard]] PairedLosses losses_of(const Binned& worse, const Binned& better, const Units& units,
                                     double bin_s);

/// Residuals of a model for all records, averaged over bins. Element i belongs to the fit without the
/// cross-validation unit i. The last element belongs to the fit to all units.
using LeftByUnit = std::vector<Binned>;

/// Fits one filter bank for each model. All models must have the same input, because the filtered signals are
/// computed only once. If a prediction of a model is not finite, the result for this model has an infinite
/// left_mm.
/// @param left  residuals of each model.
/// @param largest_kpa  largest pressure of all records.
[[nodiscard]] std::vector<FittedFilters> fit_filters(const std::vector<Record>& records, const Units& units,
                                                     FilterKind kind, double bin_s, double largest_kpa,
                                                     const std::vector<LeftByUnit>& left, std::uint64_t seed);

}  // namespace softgrip::sysid
