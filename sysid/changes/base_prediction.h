#pragma once
// Predicts the readings of a record from the baseline model of a finger, with or without the effects of a
// change. If the blocks of an effect follow all blocks of the baseline model, their output depends only on
// the sampled output of the baseline model. The baseline model is then not simulated again.

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "model/model.h"
#include "sysid/changes/base.h"
#include "sysid/changes/extension.h"
#include "sysid/changes/regulator.h"
#include "sysid/fitting/fit_space.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Returns true if two conditions hold. All `blocks` come after the blocks of `base` in the signal path. The
/// output of `blocks` at a sample depends only on the output of `base` at the samples. Returns false if the
/// command is held or if the initial state is unknown.
[[nodiscard]] bool is_downstream(const std::vector<model::BlockSpec>& blocks, const model::Model& base,
                                 const Record& record);

/// Returns the result of predict() for the baseline model followed by the blocks. The baseline model is not
/// simulated.
/// @param blocks  blocks for which is_downstream() is true.
/// @param base_mm  prediction of the baseline model for the record.
[[nodiscard]] std::vector<double> downstream(const std::vector<model::BlockSpec>& blocks,
                                             const Record& record, std::vector<double> base_mm);

/// Returns the prediction of a baseline that has no finger model: the output of the regulator, or 0 if there
/// is no regulator.
[[nodiscard]] std::vector<double> without_model(const std::optional<Regulator>& regulator,
                                                const Record& driven);

/// Returns the estimated initial state of a run that was not used to fit the model. The sensor offset in this
/// state is set to 0 mm, because the comparison of runs estimates the offset.
[[nodiscard]] StartState start_of(const model::Model& model, const Record& record);

/// A record whose drive has passed the simulated valve of a baseline model, with the predictions of the model
/// and of the filter bank.
struct Driven {
  Record record;  ///< record whose drive is the input of the finger at each sample
  /// Record that is the input of the simulation of `model`: either `record`, or the record with the command
  /// as drive.
  Record simulated;
  model::Model model;         ///< model of the finger in the baseline, including the valve blocks if they can
                              ///< be added to it
  Eigen::VectorXd filters;    ///< contribution of the filter bank at each sample
  StartState start;           ///< initial state of the model, without an offset
  std::vector<double> plain;  ///< prediction of the model alone at each sample
};
/// Simulates the valve of the baseline model.
/// @param extension  only its changes of the drive are applied: blocks and faults of the valve, and the load.
/// @param start  initial state of the model; nullptr: the initial state is estimated from the first readings
/// of the record.
[[nodiscard]] Driven driven_by(const Base& base, const Record& record, const Extension& extension = {},
                               const StartState* start = nullptr);

/// Returns the prediction of the baseline model with the effects of `extension`. The prediction contains no
/// zero offset.
/// @param driven  result of driven_by() for the record; nullptr: the function computes this result.
[[nodiscard]] std::vector<double> predict_base(const Base& base, const Record& record,
                                               const Extension& extension, const Driven* driven = nullptr);

/// Returns the reading minus the prediction of the unchanged baseline model, for each sample of each record.
[[nodiscard]] std::vector<std::vector<double>> residuals_of(const Base& base,
                                                            const std::vector<Record>& records);

}  // namespace softgrip::sysid
