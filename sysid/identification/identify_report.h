#pragma once
// Presents an identification as one sentence, an HTML page and a JSON text.

#include <string>
#include <vector>

#include "sysid/identification/identify.h"
#include "sysid/logs/log.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {

/// An identification, and the inputs that its report states.
struct IdentifyReport {
  const Identification& result;
  const std::vector<Log>& logs;
  const model::Model& start;
  std::uint64_t seed = 1;
  std::vector<Record> validation_records;
  std::vector<Score> validation;
  const std::vector<Log>* validation_logs = nullptr;
  /// Command line of the user; empty if no command started the identification.
  std::vector<std::string> call;
};

/// Returns the result as one sentence, such as "The model explains 3 logs down to the noise: RMSE of
/// 0.050 mm, at most 0.17 % of the span of each log."
[[nodiscard]] std::string verdict_of(const Identification& result);
/// Returns the page for report.html.
[[nodiscard]] Page identify_page(const IdentifyReport& report);
/// Returns the content of identify.json, with schema, rmse_mm, rmse_percent_of_span, parameters,
/// combinations, multistart, wall_s and further keys.
[[nodiscard]] std::string identify_json(const IdentifyReport& report);

}  // namespace softgrip::sysid
