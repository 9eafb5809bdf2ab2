#pragma once
// Fits a structure to a campaign. A structure consists of a base structure and of blocks. Each of these
// blocks models a possible cause.

#include <cstddef>
#include <vector>

#include "model/model.h"
#include "sysid/diagnosis/causes/cause.h"
#include "sysid/fitting/fit_space.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// A model structure with its fitted parameters.
struct StructureFit {
  /// Causes in the order in which they were added; empty: the base structure alone.
  std::vector<Cause> causes;
  FitPoint point;
  /// Reading minus prediction, one vector per record; NaN for samples without a reading.
  std::vector<std::vector<double>> residual_mm;
  /// Mean square of the residual over the readings that were fitted.
  double mean_square_mm2 = 0;
  std::size_t free_parameters = 0;
};

struct FitEffort {
  int most_iterations = 40;
  double tolerance = 1e-8;
  bool hold_starts = false;  ///< true: each record keeps its initial state from the start point
};

/// Returns the indices of the parameters that a fit of this structure changes, in the list of all parameters.
/// In the base structure, these are all parameters except exponents, fixed values and, if the hysteresis has
/// an instantaneous gain, k0. In the other blocks, the forms of the causes define these parameters.
[[nodiscard]] std::vector<std::size_t> fitted_indices(const model::Model& model,
                                                      const std::vector<Cause>& causes);

/// Returns the fit space of this structure. The forms of the causes define the ranges of their parameters.
[[nodiscard]] FitSpace structure_space(const std::vector<Record>& records, const model::Model& model,
                                       const std::vector<Cause>& causes);

/// Returns a fit space that contains the parameters of one cause, within the ranges of the cause's form. All
/// other parameters are fixed.
[[nodiscard]] FitSpace cause_space(const std::vector<Record>& records, const FitPoint& point,
                                   const Cause& cause);

/// Fits the structure to all readings of `records` by least squares, starting at `from`.
[[nodiscard]] StructureFit fit_structure(const std::vector<Record>& records, std::vector<Cause> causes,
                                         const FitPoint& from, const FitEffort& effort = {});

/// Evaluates the structure at `point` without a fit.
[[nodiscard]] StructureFit evaluate_structure(const std::vector<Record>& records, std::vector<Cause> causes,
                                              const FitPoint& point);

/// Fits the unknown initial states of the records to all readings. The parameters of the model do not change.
[[nodiscard]] StructureFit fit_starts(const std::vector<Record>& records, std::vector<Cause> causes,
                                      const FitPoint& point);

/// Subtracts the effects of these causes from the readings and returns the resulting records. The effects are
/// computed with the model of `point`.
[[nodiscard]] std::vector<Record> without_effects(std::vector<Record> records, const FitPoint& point,
                                                  const std::vector<Cause>& causes);

/// Removes one cause from the structure without a refit. The result keeps the residuals of the fit with the
/// cause.
[[nodiscard]] StructureFit without_cause(StructureFit fit, const Cause& cause);
/// Removes one cause from the structure and refits the remaining structure, starting at its current
/// parameters.
[[nodiscard]] StructureFit fit_without_cause(const std::vector<Record>& records, const StructureFit& fit,
                                             const Cause& cause);

}  // namespace softgrip::sysid
