#pragma once
// Fits a structure to a campaign. Each structure consists of a base structure and of blocks, each of which
// models a possible cause.

#include <cstddef>
#include <vector>

#include "model/model.h"
#include "sysid/diagnosis/causes/cause.h"
#include "sysid/fitting/fit_space.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// A fitted structure.
struct StructureFit {
  std::vector<Cause> causes;  ///< causes in the order in which they were added; empty: only the base
                              ///< structure
  FitPoint point;
  std::vector<std::vector<double>> residual_mm;  ///< reading minus prediction, one vector per record; NaN for
                                                 ///< samples without a reading
  double mean_square_mm2 = 0;                    ///< mean square of the fitted readings
  std::size_t free_parameters = 0;
};

struct FitEffort {
  int most_iterations = 40;
  double tolerance = 1e-8;
  bool hold_starts = false;  ///< true: the records keep the initial states of the start point
};

/// Returns the flat indices of the parameters that a fit of this structure adjusts. Of the base structure
/// these are all parameters except exponents, fixed values, and k0 if the hysteresis has an instantaneous
/// gain. For the other blocks, the forms of the causes define them.
[[nodiscard]] std::vector<std::size_t> fitted_indices(const model::Model& model,
                                                      const std::vector<Cause>& causes);

/// Returns the fit space of this structure, within the ranges of the causes' forms.
[[nodiscard]] FitSpace structure_space(const std::vector<Record>& records, const model::Model& model,
                                       const std::vector<Cause>& causes);

/// Returns a fit space with the parameters of one cause, within the ranges of its form. All other parameters
/// stay fixed.
[[nodiscard]] FitSpace cause_space(const std::vector<Record>& records, const FitPoint& point,
                                   const Cause& cause);

/// Minimises the squared error over all readings of `records`, starting at `from`.
[[nodiscard]] StructureFit fit_structure(const std::vector<Record>& records, std::vector<Cause> causes,
                                         const FitPoint& from, const FitEffort& effort = {});

/// Evaluates the structure at this point, without a fit.
[[nodiscard]] StructureFit evaluate_structure(const std::vector<Record>& records, std::vector<Cause> causes,
                                              const FitPoint& point);

/// Fits the undetermined initial states to all readings and keeps the parameters of the model.
[[nodiscard]] StructureFit fit_starts(const std::vector<Record>& records, std::vector<Cause> causes,
                                      const FitPoint& point);

/// Returns the records with readings from which the effects of these causes in the model of `point` were
/// subtracted.
[[nodiscard]] std::vector<Record> without_effects(std::vector<Record> records, const FitPoint& point,
                                                  const std::vector<Cause>& causes);

/// Removes one cause from the structure without a refit. The residuals remain those of the fit with the
/// cause.
[[nodiscard]] StructureFit without_cause(StructureFit fit, const Cause& cause);
/// Removes one cause from the structure and fits the remaining structure again, starting from its current
/// parameters.
[[nodiscard]] StructureFit fit_without_cause(const std::vector<Record>& records, const StructureFit& fit,
                                             const Cause& cause);

}  // namespace softgrip::sysid
