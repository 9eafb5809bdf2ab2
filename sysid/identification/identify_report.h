#pragma once
// What an identification says: one sentence, a page, a JSON text.

#include <string>
#include <vector>

#include "sysid/identification/identify.h"
#include "sysid/logs/log.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {

/// An identification with what it was made of.
struct IdentifyReport {
  const Identification& result;
  const std::vector<Log>& logs;
  const model::Model& start;
  std::uint64_t seed = 1;
  std::vector<Record> validation_records;
  std::vector<Score> validation;
  const std::vector<Log>* validation_logs = nullptr;
  std::vector<std::string> call;  ///< the command and what it was given; empty: by no command
};

/// "The model explains 3 logs to the noise: RMSE 0.050 mm, 0.17 % of the span."
[[nodiscard]] std::string verdict_of(const Identification& result);
/// report.html
[[nodiscard]] Page identify_page(const IdentifyReport& report);
/// identify.json: schema, rmse_mm, rmse_percent_of_span, parameters, combinations, multistart, wall_s and
/// more.
[[nodiscard]] std::string identify_json(const IdentifyReport& report);

}  // namespace softgrip::sysid
