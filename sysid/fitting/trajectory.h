#pragma once
// Simulates a record with a model and computes the residual.

#include <span>
#include <vector>

#include "model/model.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Returns the predicted reading at each sample of the record [mm]. The model is simulated from the start
/// state, and readings never correct its hidden state.
[[nodiscard]] std::vector<double> predict(const model::Model& model, const Record& record,
                                          const StartState& start);

/// Adds the offset and the unsettled creep of the initial state to `series_mm`, the predicted displacement at
/// each sample of the record. A Chain simulates neither of these two quantities.
void add_start(const model::Model& model, const Record& record, const StartState& start,
               std::vector<double>& series_mm);

/// Returns reading minus prediction for each sample [mm]; NaN for samples without a reading.
[[nodiscard]] std::vector<double> residual(const Record& record, const std::vector<double>& prediction);

/// Returns the root mean square of the errors at the samples with a reading [mm]. Returns 0 if there is no
/// reading, and infinity if the error at a reading is not finite.
/// @param readings_mm, errors_mm  one value per sample; a missing reading is NaN.
[[nodiscard]] double rms_error(std::span<const double> readings_mm, std::span<const double> errors_mm);

/// Returns the RMSE over all readings [mm], or infinity if the prediction of a reading is not finite.
/// @param starts  start state of each record.
[[nodiscard]] double rmse_of(const model::Model& model, const std::vector<StartState>& starts,
                             const std::vector<Record>& records);

/// Returns the time constants c/k of the branches in the model's first Kelvin-Voigt block [s].
[[nodiscard]] std::vector<double> branch_time_constants_s(const model::Model& model);

/// A part of a model whose creep decays exponentially. At the start of a record, it may be unsettled.
struct CreepBranch {
  double time_constant_s = 0;
  double gain_mm_per_kpa = 0;  ///< settled creep per pressure
};

/// Returns the branches in the model's first Kelvin-Voigt block, followed by its slow creep, if any. The
/// order is that of StartState::unsettled_mm.
[[nodiscard]] std::vector<CreepBranch> creep_branches(const model::Model& model);

}  // namespace softgrip::sysid
