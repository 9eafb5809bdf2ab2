#pragma once
// Validates a model: compares its predictions with logs to which it was not fitted.

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
  std::vector<Score> scores;  ///< scores of each log
  std::vector<std::string> warnings;
  std::optional<double> at_most_percent;  ///< largest permitted RMSE of a log, in % of its span
  std::vector<std::string> call;          ///< command line; empty if no command started the validation
  double wall_s = 0;
};

/// Predicts every log. The initial state is estimated from the first readings
/// (sysid/fitting/start_estimate.h).
[[nodiscard]] Validation validate_logs(const model::Model& model, const std::vector<Log>& logs,
                                       const RecordOptions& options = {});

/// Returns true if the prediction does not diverge and its RMSE does not exceed the bound (if there is a
/// bound). A log whose readings have no span exceeds every bound.
[[nodiscard]] bool is_acceptable(const Validation& validation, const Score& score);

/// Returns the result as one sentence, such as "3 logs predicted with an RMSE of 0.26 to 0.54 mm, at most 1.9
/// % of a log's span: 1 of them above the permitted 1.5 %."
[[nodiscard]] std::string verdict_of(const Validation& validation);
/// Returns the page for report.html.
[[nodiscard]] Page validate_page(const Validation& validation, const std::vector<Log>& logs);
/// Returns the content of validate.json.
[[nodiscard]] std::string validate_json(const Validation& validation, const std::vector<Log>& logs);

}  // namespace softgrip::sysid
