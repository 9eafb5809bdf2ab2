#pragma once
// A structure (a base model with some causes' blocks) fitted to a campaign.

#include <cstddef>
#include <vector>

#include "model/model.h"
#include "sysid/diagnosis/causes/cause.h"
#include "sysid/fitting/fit_space.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// A fitted structure.
struct StructureFit {
  std::vector<Cause> causes;  ///< in the order in which they were added; empty: the base alone
  FitPoint point;
  std::vector<std::vector<double>> residual_mm;  ///< reading minus prediction, by record; NaN without reading
  double mean_square_mm2 = 0;                    ///< of the readings that were fitted
  std::size_t free_parameters = 0;
};

struct FitEffort {
  int most_iterations = 40;
  double tolerance = 1e-8;
  bool hold_starts = false;  ///< the records begin as they do at the point from which the fit starts
};

/// The flat indices that a fit of this structure moves: all of the base but exponents, what stands where it
/// was put, and k0 where the hysteresis has an instantaneous gain; and what the causes' forms say.
[[nodiscard]] std::vector<std::size_t> fitted_indices(const model::Model& model,
                                                      const std::vector<Cause>& causes);

/// What a fit of this structure moves, within the ranges of the causes' forms.
[[nodiscard]] FitSpace structure_space(const std::vector<Record>& records, const model::Model& model,
                                       const std::vector<Cause>& causes);

/// The numbers of one cause alone, within the ranges of its form; the rest of the point stays.
[[nodiscard]] FitSpace cause_space(const std::vector<Record>& records, const FitPoint& point,
                                   const Cause& cause);

/// Least squares from `from`, over all readings of `records`.
[[nodiscard]] StructureFit fit_structure(const std::vector<Record>& records, std::vector<Cause> causes,
                                         const FitPoint& from, const FitEffort& effort = {});

/// The same point without fitting.
[[nodiscard]] StructureFit evaluate_structure(const std::vector<Record>& records, std::vector<Cause> causes,
                                              const FitPoint& point);

/// The same model; of the starts, what the records leave open is fitted to all readings.
[[nodiscard]] StructureFit fit_starts(const std::vector<Record>& records, std::vector<Cause> causes,
                                      const FitPoint& point);

/// The readings without what the causes of a point's model do to them.
[[nodiscard]] std::vector<Record> without_effects(std::vector<Record> records, const FitPoint& point,
                                                  const std::vector<Cause>& causes);

/// The structure without one of its causes, as it stands: its residuals are still those with the cause.
[[nodiscard]] StructureFit without_cause(StructureFit fit, const Cause& cause);
/// The same, fitted again from there.
[[nodiscard]] StructureFit fit_without_cause(const std::vector<Record>& records, const StructureFit& fit,
                                             const Cause& cause);

}  // namespace softgrip::sysid
