#pragma once
// Validation: what a model predicts for logs that it was not fitted to.

#include <string>
#include <vector>

#include "model/model.h"
#include "sysid/fitting/score.h"
#include "sysid/logs/log.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

struct Validation {
  model::Model model;
  std::vector<Record> records;
  std::vector<Score> scores;  ///< by log
  double wall_s = 0;
};

/// Predicts every log from its start; only what a log leaves open about its start is estimated.
[[nodiscard]] Validation validate_logs(const model::Model& model, const std::vector<Log>& logs,
                                       const RecordOptions& options = {});

/// "3 logs predicted with an RMSE of 0.26 to 0.54 mm, at most 1.9 % of a log's span."
[[nodiscard]] std::string verdict_of(const Validation& validation);
/// report.html
[[nodiscard]] std::string validate_html(const Validation& validation, const std::vector<Log>& logs);
/// validate.json
[[nodiscard]] std::string validate_json(const Validation& validation, const std::vector<Log>& logs);

}  // namespace softgrip::sysid
