#pragma once
// Validates a model by predictions of logs to which the model was not fitted.

#include <optional>
#include <string>
#include <vector>

#include "model/model.h"
#include "sysid/fitting/score.h"
#include "sysid/logs/log.h"
#include "sysid/logs/record.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {

struct Validation {
  model::Model model;
  std::vector<Record> records;
  std::vector<Score> scores;  ///< scores of the predictions, one element per log
  std::vector<std::string> warnings;
  std::optional<double> at_most_percent;  ///< largest permitted RMSE of a log, in % of its span
  /// Command line of the user; empty if no command started the validation.
  std::vector<std::string> call;
  double wall_s = 0;
};

/// Predicts every log with the model. The initial state is estimated from the first readings of the log
/// (sysid/fitting/start_estimate.h).
[[nodiscard]] Validation validate_logs(const model::Model& model, const std::vector<Log>& logs,
                                       const RecordOptions& options = {});

/// Returns true if the prediction of a log does not diverge and its RMSE does not exceed the bound. Without a
/// bound, every RMSE is accepted. With a bound, a log whose readings are all equal is not accepted.
[[nodiscard]] bool is_acceptable(const Validation& validation, const Score& score);

/// Returns the result as one sentence, such as "bench_twin predicts 3 logs with an RMSE of 0.26 to 0.54 mm,
/// at most 1.9 % of the span of each log: 1 of these logs with an error above the permitted 1.5 %."
[[nodiscard]] std::string verdict_of(const Validation& validation);
/// Returns the page for report.html.
[[nodiscard]] Page validate_page(const Validation& validation, const std::vector<Log>& logs);
/// Returns the content of validate.json.
[[nodiscard]] std::string validate_json(const Validation& validation, const std::vector<Log>& logs);

}  // namespace softgrip::sysid
