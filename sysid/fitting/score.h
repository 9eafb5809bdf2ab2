#pragma once
// Error of a model's prediction of a log.

#include <string>
#include <vector>

#include "model/model.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// A prediction with an RMSE above this share of the span [%] is bad, regardless of the noise.
inline constexpr double bad_percent = 10;

/// A prediction and its errors, which are reading minus prediction.
struct Score {
  std::string name;
  model::OutputUnit output_unit = model::OutputUnit::mm;  ///< unit of prediction and errors
  Drive drive = Drive::command;                           ///< input signal of the model
  std::vector<double> prediction_mm;
  std::vector<double> error_mm;  ///< NaN without reading
  double rmse_mm = 0;
  double rmse_percent_of_span = 0;
  double largest_error_mm = 0;
  double first_cycle_rmse_mm = 0;  ///< NaN if the command does not repeat
  double settled_rmse_mm = 0;      ///< RMSE of the cycles after the first; NaN if there are none
  /// True if the prediction is not finite, or if its RMSE exceeds the span of the readings and it is not
  /// proportional to them. A proportional prediction indicates a wrong unit.
  bool diverges = false;
  StartState start;
};

/// Simulates from `start` and compares the prediction with `readings`, which have the samples of the record.
[[nodiscard]] Score score_of(const model::Model& model, const Record& record, const StartState& start,
                             const std::vector<double>& readings);

/// Returns a sentence for each score that diverges: "the prediction of sp1 diverges: ...".
[[nodiscard]] std::vector<std::string> divergences_of(const std::vector<Score>& scores);

/// Returns the sample indices at which the cycles of a command begin; the first is 0. A cycle is the shortest
/// sequence of excursions from rest that repeats. If the command never repeats, each excursion is a cycle.
[[nodiscard]] std::vector<std::size_t> cycle_starts(const Record& record);

}  // namespace softgrip::sysid
