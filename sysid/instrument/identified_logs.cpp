#include "sysid/instrument/identified_logs.h"

#include <algorithm>
#include <span>
#include <string_view>
#include <utility>

#include "base/numbers.h"
#include "base/text.h"
#include "sysid/diagnosis/residual/outliers.h"
#include "sysid/fitting/score.h"
#include "sysid/logs/excitation.h"
#include "sysid/logs/plausibility_warnings.h"
#include "sysid/pages/page.h"
#include "sysid/structure/identify_structure.h"

namespace softgrip::sysid {
namespace {

/// Returns prefixes of parameter names. A fit can determine the parameters with these prefixes only if the
/// logs contain the motion `excitation`.
std::span<const std::string_view> that_need(Excitation excitation) {
  static constexpr std::string_view hysteresis[]{
      "bouc_wen.beta",       "bouc_wen.gamma",    "bouc_wen.eta",        "asymmetric_bouc_wen.",
      "prandtl_ishlinskii.", "duhem_hysteresis.", "crescent_hysteresis."};
  static constexpr std::string_view creep[]{"kelvin_voigt.k", "kelvin_voigt.c", "slow_creep.",
                                            "pressure_dependent_creep."};
  static constexpr std::string_view shape[]{"bouc_wen.gamma",       "bouc_wen.eta",
                                            "asymmetric_bouc_wen.", "prandtl_ishlinskii.",
                                            "duhem_hysteresis.",    "crescent_hysteresis."};
  switch (excitation) {
    case Excitation::unloading:
      return hysteresis;
    case Excitation::rest:
      return creep;
    case Excitation::amplitudes:
      return shape;
  }
  return {};
}

void append(std::vector<std::string>& list, std::vector<std::string> more) {
  for (std::string& one : more) list.push_back(std::move(one));
}

std::string source_of(const std::vector<Log>& logs, double rmse_mm, const model::Model& start) {
  return "identified by " + software_and_version() + " from " + with_commas(logs, &Log::name) + " (RMSE " +
         significant(rmse_mm, 3) + " " + std::string(name_of(logs.front().output_unit)) +
         "), starting from " + start.name;
}

/// Returns the error message of a fit, followed by the plausibility warnings about its logs. A warning can
/// name the cause of the error, for example a wrong unit.
std::string refusal_of(const std::string& error, const std::vector<Log>& logs) {
  std::string text = error;
  for (const std::string& implausible : plausibility_warnings_among(logs)) text += "; " + implausible;
  return text;
}

/// Returns the warnings about the logs, and about the predictions of the model for these logs.
std::vector<std::string> warnings_of_data(const Identification& result, const std::vector<Log>& logs,
                                          std::vector<std::string> wrong_readings) {
  std::vector<std::string> warnings = std::move(wrong_readings);
  append(warnings, excitation_limits(logs, result.parameters));
  append(warnings, plausibility_warnings_among(logs));
  append(warnings, divergences_of(result.scores));
  append(warnings, divergences_of(result.held_out));
  return warnings;
}

}  // namespace

std::vector<std::string> excitation_limits(const std::vector<Log>& logs,
                                           const std::vector<Estimate>& parameters) {
  std::vector<std::string> sentences;
  for (const Excitation missing : missing_excitation(logs)) {
    std::string names;
    for (const Estimate& estimate : parameters) {
      const auto begins = [&](std::string_view name) { return estimate.name.starts_with(name); };
      if (estimate.free && std::ranges::any_of(that_need(missing), begins))
        names += (names.empty() ? "" : ", ") + estimate.name;
    }
    sentences.push_back(
        without(missing) +
        (names.empty() ? "" : "; the following parameters require the missing excitation: " + names));
  }
  return sentences;
}

IdentifyReport IdentifiedLogs::report(std::vector<std::string> call) const {
  return {result,
          logs,
          start,
          seed,
          validation_records,
          validation,
          validation_logs.empty() ? nullptr : &validation_logs,
          std::move(call)};
}

tl::expected<IdentifiedLogs, std::string> identify_logs(IdentifyQuestion question) {
  IdentifiedLogs all;
  all.logs = std::move(question.logs);
  all.validation_logs = std::move(question.validation);
  all.seed = question.options.seed;
  std::vector<std::string> repetitions =
      repetition_warnings(all.validation_logs, all.logs, "the fitted log",
                          "The error on this log is therefore not an error on new data");
  std::vector<std::string> wrong_readings = take_out_wrong_readings(all.logs);
  append(wrong_readings, take_out_wrong_readings(all.validation_logs));
  const bool given = question.start.has_value();
  all.start = given ? std::move(*question.start) : base_model(all.logs, question.branches);
  auto result = question.structure ? identify_structure(all.logs, *question.structure, question.options)
                                   : identify(all.logs, all.start, question.options);
  if (!result) return tl::unexpected(refusal_of(result.error(), all.logs));
  all.result = *std::move(result);
  if (question.structure && given)
    all.result.warnings.push_back(
        "--structure computes the start values from the data: " + question.start_file + " was not used");
  if (given) {
    all.result.model.name = all.start.name + "_identified";
  } else {
    all.start.name = question.structure ? "structures, with start values from the scale of the data"
                                        : "base structure, with start values from the scale of the data";
  }
  std::vector<std::string> warnings = warnings_of_data(all.result, all.logs, std::move(wrong_readings));
  append(warnings, std::move(all.result.warnings));
  all.result.warnings = std::move(warnings);
  all.result.model.source = source_of(all.logs, all.result.rmse_mm, all.start);
  if (!all.validation_logs.empty()) {
    Validation validation = validate_logs(all.result.model, all.validation_logs, question.options.record);
    all.validation_records = std::move(validation.records);
    all.validation = std::move(validation.scores);
    append(all.result.warnings, std::move(repetitions));
    append(all.result.warnings, std::move(validation.warnings));
  }
  return all;
}

Validation validate_given_logs(const model::Model& model, std::vector<Log>& logs,
                               const RecordOptions& options) {
  std::vector<std::string> warnings = take_out_wrong_readings(logs);
  Validation validation = validate_logs(model, logs, options);
  append(warnings, std::move(validation.warnings));
  validation.warnings = std::move(warnings);
  return validation;
}

}  // namespace softgrip::sysid
