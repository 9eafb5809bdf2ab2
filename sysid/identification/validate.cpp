#include "sysid/identification/validate.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <nlohmann/json.hpp>

#include "base/json.h"
#include "base/numbers.h"
#include "model/file/model_file.h"
#include "sysid/fitting/start_estimate.h"
#include "sysid/identification/log_report.h"
#include "sysid/logs/plausibility_warnings.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {
namespace {

/// A prediction is good if its RMSE is below this percentage of the span.
constexpr double good_percent = 2;

double largest_percent(const Validation& v) {
  double largest = 0;
  for (const Score& s : v.scores) largest = std::max(largest, s.rmse_percent_of_span);
  return largest;
}

bool is_above_bound(const Validation& v, const Score& s) {
  return v.at_most_percent && !(s.rmse_percent_of_span <= *v.at_most_percent);
}

/// Returns a text such as ": 2 of these logs with an error above the permitted 1 %". Returns "" if there is
/// no bound or no log exceeds the bound.
std::string bound_text(const Validation& v) {
  const auto above =
      std::count_if(v.scores.begin(), v.scores.end(), [&](const Score& s) { return is_above_bound(v, s); });
  if (above == 0) return {};
  const std::string which =
      v.scores.size() == 1 ? std::string() : std::to_string(above) + " of these logs with an error ";
  return ": " + which + "above the permitted " + significant(*v.at_most_percent) + " %";
}

std::string start_text(const Record& record, const StartState& start) {
  const std::string offset =
      "offset " + significant(start.offset_mm, 3) + " " + std::string(model::name_of(record.output_unit));
  return is_at_rest(start, record) ? "at rest, " + offset + " estimated"
                                   : "state and " + offset + " estimated (the log does not begin at rest)";
}

}  // namespace

Validation validate_logs(const model::Model& model, const std::vector<Log>& logs,
                         const RecordOptions& options) {
  const auto began = std::chrono::steady_clock::now();
  Validation v;
  v.model = model;
  v.records = make_records(logs, options);
  const model::Model part = deterministic_part(model, options.drive);
  const std::vector<StartState> starts = estimated_starts(part, v.records);
  for (std::size_t i = 0; i < v.records.size(); ++i) {
    v.scores.push_back(score_of(part, v.records[i], starts[i], v.records[i].reading_mm));
  }
  v.warnings = plausibility_warnings_among(logs, "The result lists the error of these samples twice");
  for (std::string& sentence : divergences_of(v.scores)) v.warnings.push_back(std::move(sentence));
  for (std::size_t i = 0; i < v.scores.size(); ++i) {
    if (std::string implausible = scale_warning(logs[i].name, v.scores[i].prediction_mm,
                                                v.records[i].reading_mm, logs[i].output_unit);
        !implausible.empty())
      v.warnings.push_back(std::move(implausible));
  }
  v.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return v;
}

bool is_acceptable(const Validation& v, const Score& score) {
  return !score.diverges && !is_above_bound(v, score);
}

std::string verdict_of(const Validation& v) {
  double lowest = v.scores.front().rmse_mm;
  double highest = lowest;
  for (const Score& s : v.scores) {
    lowest = std::min(lowest, s.rmse_mm);
    highest = std::max(highest, s.rmse_mm);
  }
  const std::string logs =
      v.scores.size() == 1 ? v.scores.front().name : std::to_string(v.scores.size()) + " logs";
  if (!std::isfinite(highest))
    return v.model.name + " does not predict " + logs + ", because a predicted value is not finite.";
  const std::string share = significant(largest_percent(v), 2);
  const std::string size = v.scores.size() == 1 ? significant(highest, 3)
                                                : significant(lowest, 3) + " to " + significant(highest, 3);
  return v.model.name + " predicts " + logs + " with an RMSE of " + size + " " +
         std::string(model::name_of(v.model.output_unit)) + ", " +
         (v.scores.size() == 1 ? share + " % of the span of the log"
                               : "at most " + share + " % of the span of each log") +
         bound_text(v) + ".";
}

Page validate_page(const Validation& v, const std::vector<Log>& logs) {
  const double percent = largest_percent(v);
  Page page("Validation of " + v.model.name, verdict_of(v),
            !bound_text(v).empty()   ? Tone::bad
            : percent < good_percent ? Tone::good
            : percent < bad_percent  ? Tone::doubtful
                                     : Tone::bad);
  page.provenance(provenance_of(logs, {{"model", &v.model}}));
  if (!v.warnings.empty()) {
    page.section("Plausibility warnings");
    page.list(v.warnings);
  }
  page.section("Prediction");
  page.table(score_table(v.records, v.scores));
  std::vector<std::string> starts;
  for (std::size_t i = 0; i < v.scores.size(); ++i) {
    starts.push_back(v.scores[i].name + ": start " + start_text(v.records[i], v.scores[i].start));
  }
  page.list(starts);
  for (std::size_t i = 0; i < v.scores.size(); ++i) add_log_figures(page, v.records[i], v.scores[i]);
  page.section("Model file");
  page.code(model::to_yaml(v.model));
  return page;
}

std::string validate_json(const Validation& v, const std::vector<Log>& logs) {
  nlohmann::ordered_json json{
      {"schema", 1}, {"software", software_and_version()}, {"verdict", verdict_of(v)}};
  json["call"] = v.call;
  json["model"] = {{"name", v.model.name}, {"hash", model::model_hash(v.model)}};
  json["output_unit"] = model::name_of(v.model.output_unit);
  json["logs"] = result::json_of(logs_value(logs));
  json.update(result::json_of(fields_of(v.scores)));
  if (v.at_most_percent) {
    json["at_most_percent"] = *v.at_most_percent;
    for (const Score& s : v.scores) json["acceptable"][s.name] = is_acceptable(v, s);
  }
  json["warnings"] = v.warnings;
  for (std::size_t i = 0; i < v.scores.size(); ++i) {
    json["offset_mm"][v.scores[i].name] = v.scores[i].start.offset_mm;
  }
  json["wall_s"] = v.wall_s;
  return json_dump(json, 2) + "\n";
}

}  // namespace softgrip::sysid
