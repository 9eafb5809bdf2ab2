#include "library/include/softgrip/diagnose.h"

#include <limits>
#include <utility>

#include <nlohmann/json.hpp>

#include "library/log_parts.h"
#include "library/model_parts.h"
#include "sysid/changes/change.h"
#include "sysid/changes/change_report.h"
#include "sysid/diagnosis/report/report.h"
#include "sysid/diagnosis/verdict/diagnosis.h"

namespace softgrip {
namespace {

Cause public_cause(const sysid::NamedCause& named) {
  Cause cause;
  cause.id = named.cause.id;
  cause.title = named.cause.title;
  cause.error_reduction_percent = named.gain_percent.value;
  cause.error_reduction_ci95 = {named.gain_percent.lower, named.gain_percent.upper};
  for (const sysid::CauseParameter& parameter : named.parameters) {
    Estimate estimate{parameter.name, parameter.unit, parameter.value, {}, true, {}};
    if (parameter.has_interval) estimate.ci95 = Interval{parameter.ci95.lower, parameter.ci95.upper};
    cause.parameters.push_back(std::move(estimate));
  }
  for (const sysid::Cause& other : named.alternatives) cause.alternatives.emplace_back(other.id);
  return cause;
}

Cause public_cause(const sysid::ChangeCause& changed) {
  Cause cause;
  cause.id = changed.id;
  cause.title = changed.title;
  if (changed.reduction) {
    const auto& [share, interval] = *changed.reduction;
    cause.error_reduction_percent = 100 * share;
    cause.error_reduction_ci95 = {100 * interval.lower, 100 * interval.upper};
  } else {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    cause.error_reduction_percent = unknown;
    cause.error_reduction_ci95 = {unknown, unknown};
  }
  cause.parameters.push_back({changed.size.what,
                              model::in_unit(changed.size.unit, changed.output_unit),
                              changed.size.value,
                              library::interval_of(changed.intervals.size),
                              true,
                              {}});
  cause.alternatives = changed.alternatives;
  return cause;
}

}  // namespace

Diagnosis diagnose(const Model& model, const std::vector<Log>& logs, const DiagnoseOptions& options) {
  const std::vector<sysid::Log> checked =
      library::checked_logs("logs", logs, options.use, false, library::needed_for(model));
  sysid::DiagnosisOptions search;
  search.record = library::record_options(options.use);
  search.seed = options.seed;
  search.threads = options.threads;
  search.null_campaigns = options.null_campaigns;
  search.progress = options.progress;
  const auto found = library::cancellable(options.threads, options.stop, [&] {
    auto diagnosis = sysid::diagnose(checked, model.parts().value, search);
    if (diagnosis) sysid::examine(*diagnosis, search);
    return diagnosis;
  });
  if (!found) throw Refused(found.error());
  std::vector<Cause> causes;
  for (const sysid::NamedCause& named : found->causes) causes.push_back(public_cause(named));
  const sysid::DiagnosisReport report{*found, checked, model.parts().value, options.seed, {}, {}};
  return {std::string(sysid::name_of(sysid::whole_verdict(*found))),
          sysid::verdict_sentence(*found),
          found->warnings,
          std::move(causes),
          model.unit(),
          found->noise_mm,
          found->as_given_rmse_mm,
          found->recalibrated_rmse_mm,
          found->extended_rmse_mm,
          found->unexplained_percent,
          library::wrapped(found->recalibrated_model),
          library::wrapped(found->extended_model),
          result::json_text(sysid::fields_of(*found)),
          sysid::diagnosis_page(report).to_html()};
}

Change diagnose_change(const Model& model, const std::vector<Log>& healthy, const std::vector<Log>& later,
                       const DiagnoseOptions& options) {
  LogUse use = options.use;
  use.drive = Drive::command;
  const std::vector<sysid::Log> before =
      library::checked_logs("healthy", healthy, use, false, library::needed_for(model));
  const std::vector<sysid::Log> now =
      library::checked_logs("later", later, use, false, library::needed_for(model));
  sysid::ChangeOptions search;
  search.held = use.held;
  search.given = model.parts().value;
  search.seed = options.seed;
  search.threads = options.threads;
  search.progress = options.progress;
  const auto found = library::cancellable(options.threads, options.stop,
                                          [&] { return sysid::diagnose_change(before, now, search); });
  if (!found) throw Refused(found.error());
  std::vector<Cause> causes;
  for (const sysid::ChangeCause& cause : found->causes) causes.push_back(public_cause(cause));
  return {std::string(sysid::name_of(found->verdict)),
          sysid::change_sentence(*found),
          found->warnings,
          std::move(causes),
          model.unit(),
          result::json_text(sysid::fields_of(*found)),
          sysid::change_page(*found, before, now, model.parts().value).to_html()};
}

}  // namespace softgrip
