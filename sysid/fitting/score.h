#pragma once
// How well a model predicts a log.

#include <string>
#include <vector>

#include "model/model.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Above this share of the span a prediction is bad, whatever the noise.
inline constexpr double bad_percent = 10;

/// A prediction and its errors. Errors are reading minus prediction.
struct Score {
  std::string name;
  model::OutputUnit output_unit = model::OutputUnit::mm;  ///< of prediction and errors
  Drive drive = Drive::command;                           ///< which signal drove the model
  std::vector<double> prediction_mm;
  std::vector<double> error_mm;  ///< NaN without reading
  double rmse_mm = 0;
  double rmse_percent_of_span = 0;
  double largest_error_mm = 0;
  double first_cycle_rmse_mm = 0;  ///< NaN where the command does not repeat
  double settled_rmse_mm = 0;      ///< of the cycles after the first; NaN where there are none
  /// The prediction is not finite, or its RMSE is larger than the span of the readings and it is no multiple
  /// of them, as in another unit.
  bool diverges = false;
  StartState start;
};

/// Simulates from `start` and compares with `readings` (those of the record, or others of the same samples).
[[nodiscard]] Score score_of(const model::Model& model, const Record& record, const StartState& start,
                             const std::vector<double>& readings);

/// "the prediction of sp1 diverges: ..." for each score that does.
[[nodiscard]] std::vector<std::string> divergences_of(const std::vector<Score>& scores);

/// Where the cycles of a command begin: indices of samples, the first 0. A cycle is the shortest sequence of
/// excursions from rest that repeats; a command that never repeats has one excursion per cycle.
[[nodiscard]] std::vector<std::size_t> cycle_starts(const Record& record);

}  // namespace softgrip::sysid
