#pragma once
// Computes the error of the prediction of a log by a model.

#include <string>
#include <vector>

#include "model/model.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// A prediction is bad if its RMSE exceeds this percentage of the span. The noise does not affect this limit.
inline constexpr double bad_percent = 10;

/// A prediction and its errors. An error is reading minus prediction.
struct Score {
  std::string name;
  model::OutputUnit output_unit = model::OutputUnit::mm;  ///< unit of the prediction and its errors
  Drive drive = Drive::command;                           ///< input signal of the model
  std::vector<double> prediction_mm;
  std::vector<double> error_mm;  ///< reading minus prediction; NaN for samples without a reading
  double rmse_mm = 0;
  double rmse_percent_of_span = 0;
  double largest_error_mm = 0;
  double first_cycle_rmse_mm = 0;  ///< RMSE of the first cycle; NaN if the command does not repeat
  double settled_rmse_mm = 0;      ///< RMSE of the cycles after the first; NaN if there is only one cycle
  /// True if the prediction is not finite. Also true if its RMSE exceeds the span of the readings and the
  /// prediction is not proportional to the readings. If it is proportional, a unit is probably wrong.
  bool diverges = false;
  StartState start;
};

/// Simulates the record from `start` and compares the prediction with `readings`, which has one element per
/// sample of the record.
[[nodiscard]] Score score_of(const model::Model& model, const Record& record, const StartState& start,
                             const std::vector<double>& readings);

/// Returns a sentence such as "the prediction of sp1 diverges: ..." for each score that diverges.
[[nodiscard]] std::vector<std::string> divergences_of(const std::vector<Score>& scores);

/// Returns the indices of the samples at which the cycles of a command begin. The first index is 0. A cycle
/// is the shortest sequence of excursions from rest that is repeated. If no sequence is repeated, each
/// excursion is a cycle.
[[nodiscard]] std::vector<std::size_t> cycle_starts(const Record& record);

}  // namespace softgrip::sysid
