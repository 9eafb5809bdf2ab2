#include "library/include/softgrip/identify.h"

#include <utility>

#include "base/numbers.h"
#include "library/include/softgrip/validate.h"
#include "library/log_parts.h"
#include "library/model_parts.h"
#include "sysid/fitting/multistart.h"
#include "sysid/identification/identify_report.h"
#include "sysid/identification/validate.h"
#include "sysid/instrument/identified_logs.h"

namespace softgrip {
namespace {

std::optional<sysid::StructureQuestion> question_of(Structure structure) {
  switch (structure) {
    case Structure::start:
      return std::nullopt;
    case Structure::automatic:
      return sysid::StructureQuestion::automatic;
    case Structure::bouc_wen:
      return sysid::StructureQuestion::bouc_wen;
    case Structure::prandtl_ishlinskii:
      return sysid::StructureQuestion::prandtl_ishlinskii;
  }
  throw InvalidArgument("structure", "not a Structure");
}

sysid::ShowProgress progress_of(const Progress& progress) {
  if (!progress) return {};
  return [progress](const sysid::Progress& now) {
    if (!now.stage.empty()) return progress(now.stage);
    progress("start " + std::to_string(now.done) + " of " + std::to_string(now.starts) + ", best RMSE " +
             significant(now.best_rmse_mm, 4));
  };
}

/// Throws InvalidArgument if the options request a choice of the structure and also contain a setting of a
/// fit whose structure is given.
void require_free_choice(const IdentifyOptions& options) {
  const std::string choice = "the options request a choice of the structure, but also ";
  if (options.start)
    throw InvalidArgument(
        "start", choice + "contain a start model. To fit the start model, use the structure `start`");
  const auto refuse_unless = [&](const char* argument, bool is_default) {
    if (!is_default)
      throw InvalidArgument(
          argument, choice + "set `" + argument + "`. To use this setting, use the structure `start`");
  };
  refuse_unless("branches", options.branches == IdentifyOptions{}.branches);
  refuse_unless("fixed", options.fixed.empty());
  refuse_unless("free", options.free.empty());
  refuse_unless("robust", !options.robust);
}

/// Throws InvalidArgument if the model has no parameter with one of the names.
void require_parameters(const std::string& argument, const std::vector<std::string>& names,
                        const model::Model& model) {
  for (const std::string& name : names) {
    if (!model::find_path(model, name))
      throw InvalidArgument(argument, library::unknown_parameter(model, name));
  }
}

std::vector<Estimate> estimates_of(const std::vector<sysid::Estimate>& list) {
  std::vector<Estimate> all;
  all.reserve(list.size());
  for (const sysid::Estimate& one : list)
    all.push_back({one.name, one.unit, one.value, library::interval_of(one.ci95), one.free, one.note});
  return all;
}

}  // namespace

namespace library {

std::optional<Interval> interval_of(const std::optional<sysid::Interval>& interval) {
  if (!interval) return std::nullopt;
  return Interval{interval->lower, interval->upper};
}

std::vector<Prediction> predictions_of(const std::vector<sysid::Record>& records,
                                       const std::vector<sysid::Score>& scores) {
  std::vector<Prediction> all;
  all.reserve(scores.size());
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const sysid::Score& score = scores[i];
    all.push_back({score.name, unit_of(score.output_unit), records[i].time_s, score.prediction_mm,
                   score.error_mm, score.rmse_mm, score.rmse_percent_of_span, score.largest_error_mm,
                   score.diverges});
  }
  return all;
}

}  // namespace library

Identification identify(const std::vector<Log>& logs, const IdentifyOptions& options) {
  sysid::IdentifyQuestion question;
  question.structure = question_of(options.structure);
  if (question.structure) require_free_choice(options);
  library::require_between("branches", static_cast<double>(options.branches), 1, 8, "");
  library::require_between("starts", static_cast<double>(options.starts), 1, 10000, "");
  library::require_between("fit_share", options.fit_share, 0.05, 1, "");
  question.logs = library::checked_logs(
      "logs", logs, options.use, question.structure.has_value(),
      options.start ? std::optional(library::needed_for(*options.start)) : std::nullopt);
  if (!options.validation.empty())
    question.validation = library::checked_logs("validation", options.validation, options.use, false,
                                                library::NeededUnit{logs.front().name, logs.front().unit});
  if (options.start) question.start = options.start->parts().value;
  if (!question.structure && !(options.fixed.empty() && options.free.empty())) {
    const model::Model fitted =
        question.start ? *question.start : sysid::base_model(question.logs, options.branches);
    require_parameters("fixed", options.fixed, fitted);
    require_parameters("free", options.free, fitted);
  }
  question.branches = options.branches;
  question.options.fixed = options.fixed;
  question.options.free = options.free;
  question.options.starts = options.starts;
  question.options.seed = options.seed;
  question.options.threads = options.threads;
  question.options.robust = options.robust;
  question.options.fit_share = options.fit_share;
  question.options.record = library::record_options(options.use);
  question.options.progress = progress_of(options.progress);
  const auto all = library::cancellable(options.threads, options.stop,
                                        [&] { return sysid::identify_logs(std::move(question)); });
  if (!all) throw Refused(all.error());
  const sysid::Identification& found = all->result;
  const sysid::IdentifyReport report = all->report({});
  return {library::wrapped(found.model),
          found.rmse_mm,
          found.converged,
          sysid::verdict_of(found),
          found.warnings,
          estimates_of(found.parameters),
          estimates_of(found.combinations),
          library::predictions_of(found.records, found.scores),
          library::predictions_of(found.records, found.held_out),
          library::predictions_of(all->validation_records, all->validation),
          sysid::identify_json(report),
          sysid::identify_page(report).to_html()};
}

Validation validate(const Model& model, const std::vector<Log>& logs, const LogUse& use) {
  return validate(model, logs, use, {});
}

Validation validate(const Model& model, const std::vector<Log>& logs, const LogUse& use,
                    const std::stop_token& stop) {
  std::vector<sysid::Log> checked =
      library::checked_logs("logs", logs, use, false, library::needed_for(model));
  const sysid::Validation found = library::cancellable(0, stop, [&] {
    return sysid::validate_given_logs(model.parts().value, checked, library::record_options(use));
  });
  return {sysid::verdict_of(found), found.warnings, library::predictions_of(found.records, found.scores),
          sysid::validate_json(found, checked), sysid::validate_page(found, checked).to_html()};
}

}  // namespace softgrip
