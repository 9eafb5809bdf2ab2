#pragma once
// Validation: what a model predicts for logs that it was not fitted to.

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
  std::vector<Score> scores;  ///< by log
  std::vector<std::string> warnings;
  std::optional<double> at_most_percent;  ///< bound of every log's RMSE, as a share of its span
  std::vector<std::string> call;          ///< the command and what it was given; empty: by no command
  double wall_s = 0;
};

/// Predicts every log from its start, which its first readings tell (sysid/fitting/start_estimate.h).
[[nodiscard]] Validation validate_logs(const model::Model& model, const std::vector<Log>& logs,
                                       const RecordOptions& options = {});

/// Whether the prediction of a log stays within the bound, if there is one, and does not diverge. One whose
/// readings have no span does not stay within a bound.
[[nodiscard]] bool is_acceptable(const Validation& validation, const Score& score);

/// "3 logs predicted with an RMSE of 0.26 to 0.54 mm, at most 1.9 % of a log's span: 1 of them more than
/// the 1.5 % that were allowed."
[[nodiscard]] std::string verdict_of(const Validation& validation);
/// report.html
[[nodiscard]] Page validate_page(const Validation& validation, const std::vector<Log>& logs);
/// validate.json
[[nodiscard]] std::string validate_json(const Validation& validation, const std::vector<Log>& logs);

}  // namespace softgrip::sysid
