#pragma once
// Fits a structure to a campaign. A structure consists of a base structure and additional blocks. Each
// additional block models a possible cause of the model error.

#include <cstddef>
#include <vector>

#include "model/model.h"
#include "sysid/diagnosis/causes/cause.h"
#include "sysid/fitting/fit_space.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// A model structure with its fitted parameters.
struct StructureFit {
  /// Causes in the order in which they were added to the base structure; empty: the structure has no causes.
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
  /// The fit ends after a step that reduces the sum of squares by less than this share, or by less than 1 %
  /// of the noise variance. Such a step moves no parameter by more than about 0.1 standard errors.
  double tolerance = 1e-8;
  bool hold_starts = false;  ///< true: the initial state of each record stays the same as at the start point
                             ///< of the fit
};

/// Damping of a Gauss-Newton step of a linearised structure, as a share of the diagonal elements of the
/// normal matrix. The damping limits steps in directions that the data hardly determine.
inline constexpr double step_damping = 1e-3;

/// Returns the indices of the parameters that a fit of this structure changes. The indices refer to the list
/// of all parameters. In the base structure, the exponents and fixed values are not changed. k0 is not
/// changed if the hysteresis has an instantaneous gain. In the blocks of causes, the forms of the causes
/// define which parameters are changed.
[[nodiscard]] std::vector<std::size_t> fitted_indices(const model::Model& model,
                                                      const std::vector<Cause>& causes);

/// Returns the parameter space in which this structure is fitted. The forms of the causes limit the ranges of
/// their parameters.
[[nodiscard]] FitSpace structure_space(const std::vector<Record>& records, const model::Model& model,
                                       const std::vector<Cause>& causes);

/// Returns a parameter space with the parameters of one cause. The form of the cause limits their ranges. All
/// other parameters are fixed.
[[nodiscard]] FitSpace cause_space(const std::vector<Record>& records, const FitPoint& point,
                                   const Cause& cause);

/// Fits the structure to all readings of `records` by least squares. The fit starts at `from`.
[[nodiscard]] StructureFit fit_structure(const std::vector<Record>& records, std::vector<Cause> causes,
                                         const FitPoint& from, const FitEffort& effort = {});

/// Computes the residual of the structure at `point`. Nothing is fitted.
[[nodiscard]] StructureFit evaluate_structure(const std::vector<Record>& records, std::vector<Cause> causes,
                                              const FitPoint& point);

/// Fits only the unknown initial states of the records. The parameters of the model stay constant.
[[nodiscard]] StructureFit fit_starts(const std::vector<Record>& records, std::vector<Cause> causes,
                                      const FitPoint& point);

/// Returns the records after the effects of these causes are subtracted from the readings. The effects are
/// computed with the model of `point`.
[[nodiscard]] std::vector<Record> without_effects(std::vector<Record> records, const FitPoint& point,
                                                  const std::vector<Cause>& causes);

/// Removes one cause from the model and from the list of causes. The remaining structure is not refitted, so
/// the result keeps the residuals of the fit with the cause.
[[nodiscard]] StructureFit without_cause(StructureFit fit, const Cause& cause);
/// Removes one cause from the structure and refits the remaining structure. The refit starts at the current
/// parameters.
[[nodiscard]] StructureFit fit_without_cause(const std::vector<Record>& records, const StructureFit& fit,
                                             const Cause& cause, const FitEffort& effort = {});

}  // namespace softgrip::sysid
