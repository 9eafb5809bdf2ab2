#pragma once
// Computes the error with which a model predicts a log.

#include <string>
#include <vector>

#include "model/model.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Percentage of the span of the readings. A prediction is bad if its RMSE exceeds this percentage. The limit
/// does not depend on the noise of the readings.
inline constexpr double bad_percent = 10;

/// A prediction and its errors. An error is reading minus prediction. If the prediction of a reading is not
/// finite, the RMSE of an interval that contains this reading and the largest error are infinite.
struct Score {
  std::string name;
  model::OutputUnit output_unit = model::OutputUnit::mm;  ///< unit of the prediction and its errors
  Drive drive = Drive::command;                           ///< input signal of the model
  std::vector<double> prediction_mm;
  std::vector<double> error_mm;  ///< reading minus prediction; NaN for samples without a reading
  double rmse_mm = 0;
  double rmse_percent_of_span = 0;
  double largest_error_mm = 0;
  double first_cycle_rmse_mm =
      0;  ///< RMSE of the first cycle (see cycle_starts()); NaN if there is only one cycle
  double settled_rmse_mm = 0;  ///< RMSE of the cycles after the first; NaN if there is only one cycle
  /// True if the prediction is not finite. Also true if its RMSE exceeds the span of the readings and the
  /// magnitude of its correlation with the readings is below 0.9. With a higher correlation, a unit is
  /// probably wrong, and the prediction does not count as divergent.
  bool diverges = false;
  StartState start;
};

/// Simulates the record from `start` and compares the prediction with `readings`, which has one element per
/// sample of the record.
[[nodiscard]] Score score_of(const model::Model& model, const Record& record, const StartState& start,
                             const std::vector<double>& readings);

/// Returns a sentence such as "the prediction of sp1 diverges, because ..." for each score whose prediction
/// diverges.
[[nodiscard]] std::vector<std::string> divergences_of(const std::vector<Score>& scores);

/// Returns the indices of the samples at which the cycles of a command begin. The first index is 0. A cycle
/// is the shortest sequence of excursions from rest that is repeated. If no sequence is repeated, each
/// excursion is a cycle.
[[nodiscard]] std::vector<std::size_t> cycle_starts(const Record& record);

}  // namespace softgrip::sysid
