#pragma once
// Fits the model structures that may become the baseline model, to all healthy runs and to all runs except
// one cross-validation unit (sysid/evidence/units.h).

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sysid/changes/base.h"
#include "sysid/structure/structure.h"

namespace softgrip::sysid {

/// Parameters of a model that was fitted to records.
struct FittedParameters {
  FitPoint point;
  NonlinearNumbers numbers;  ///< nonlinear parameters of a structure with columns (StructureColumns)
};

/// Returns the parameters with the initial states of some of the records.
/// @param kept  indices of these records.
[[nodiscard]] FittedParameters for_records(FittedParameters parameters, const std::vector<std::size_t>& kept);

/// A model structure that may become the baseline model, with the functions that fit its parameters. They
/// fit the model to records whose drive is the output of the regulator. A model without blocks predicts the
/// output of the regulator, or 0 if there is no regulator.
struct BaseCandidate {
  std::string description;
  std::optional<Regulator> regulator;
  /// Fits the model to all records.
  std::function<FittedParameters(const std::vector<Record>&)> fit;
  /// Fits the model to some of the records. The fit starts at the parameters that were fitted to all records.
  std::function<FitPoint(const std::vector<Record>&, const FittedParameters&)> refit;
};

/// Returns the candidate with play operators and creep. Its input is the drive of the records that it is
/// fitted to.
[[nodiscard]] BaseCandidate play_candidate(Drive drive);

/// Returns the candidates for the baseline model. The first one is the default.
[[nodiscard]] std::vector<BaseCandidate> base_candidates(const std::vector<Record>& records, Judged judged,
                                                         Drive drive, double largest_kpa,
                                                         const BaseOptions& options);

/// Returns the residual of a fitted candidate for all records, averaged over bins.
/// @param kept  for each record of the fit, its index in `records`.
[[nodiscard]] Binned left_by(const BaseCandidate& candidate, const FitPoint& point,
                             const std::vector<std::size_t>& kept, const std::vector<Record>& records,
                             double bin_s);
/// A candidate that was fitted to all cross-validation units except one.
struct LeftOutFit {
  model::Model model;
  Binned left;  ///< residual for all records, averaged over bins
};
/// Fits a candidate to all cross-validation units except one. The fit starts at the parameters that were
/// fitted to all records.
[[nodiscard]] LeftOutFit fit_without(const BaseCandidate& candidate, const FittedParameters& whole,
                                     const std::vector<Record>& records, const Units& units, std::size_t unit,
                                     double bin_s);

}  // namespace softgrip::sysid
