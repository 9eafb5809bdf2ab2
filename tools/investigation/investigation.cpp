#include "tools/investigation/investigation.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/enum_table.h"
#include "base/numbers.h"
#include "sysid/diagnosis/causes/contact.h"
#include "sysid/logs/record.h"
#include "tools/investigation/experiment_rig.h"

namespace softgrip::tools {
namespace {

using result::Fields, result::number, result::shown, result::Value;
using sysid::Verdict;

/// Largest number of steps of an investigation. It exceeds the number of waveforms that experiments can
/// apply.
constexpr std::size_t most_steps = 20;

/// Returns the causes of a step, each with its alternatives, as text.
std::string causes_of(const InvestigationStep& step) {
  std::string text;
  for (std::size_t i = 0; i < step.causes.size(); ++i) {
    text += (i == 0 ? "" : "; ") + step.causes[i];
    for (const std::string& alternative : step.alternatives[i]) text += " or " + alternative;
  }
  return text.empty() ? "-" : text;
}

InvestigationStep step_of(const sysid::Diagnosis& diagnosis, const std::string& folder) {
  InvestigationStep step;
  step.folder = folder;
  step.verdict = diagnosis.verdict;
  step.sentence = sysid::verdict_sentence(diagnosis);
  step.recalibrated_rmse_mm = diagnosis.recalibrated_rmse_mm;
  step.extended_rmse_mm = diagnosis.extended_rmse_mm;
  for (const sysid::NamedCause& named : diagnosis.causes) {
    step.causes.emplace_back(named.cause.id);
    step.alternatives.emplace_back();
    for (const sysid::Cause& alternative : named.alternatives)
      step.alternatives.back().emplace_back(alternative.id);
  }
  return step;
}

class Investigator {
 public:
  explicit Investigator(const InvestigationOptions& options) : options_(options), plan_(options.experiment) {
    result_.logs = options.logs;
    result_.budget_minutes = options.budget_minutes;
    result_.gauge = options.diagnosis.gauge;
  }

  tl::expected<Investigation, NotInvestigated> run() {
    while (result_.steps.size() < most_steps) {
      const auto goes_on = step();
      if (!goes_on) return tl::unexpected(goes_on.error());
      if (!*goes_on) return std::move(result_);
    }
    end(InvestigationEnd::nothing_left, "all available experiments were run");
    return std::move(result_);
  }

 private:
  /// Makes one diagnosis. If the diagnosis proposes an experiment, plays this experiment. Returns false at
  /// the end of the investigation.
  tl::expected<bool, NotInvestigated> step() {
    const std::string name = "step_" + std::to_string(result_.steps.size() + 1);
    sysid::DiagnosisOptions how = options_.diagnosis;
    how.gauge = result_.gauge;
    auto diagnosis = sysid::diagnose(result_.logs, options_.given, how);
    if (how.progress) how.progress("");
    if (!diagnosis) return tl::unexpected(NotInvestigated{ExitCode::input_refused, diagnosis.error()});
    result_.last = std::move(*diagnosis);
    result_.steps.push_back(step_of(result_.last, name));
    tell(name + ": " + result_.steps.back().sentence);

    Consequences consequences;
    plan_.most_minutes = result_.budget_minutes - result_.spent_minutes;
    consequences.experiment = sysid::design_experiment(result_.last, plan_);
    const std::string folder = (std::filesystem::path(options_.out) / name).string();
    const DiagnosisSource source{result_.logs, options_.given, {}};
    if (auto written = write_diagnosis_folder(folder, result_.last, source, consequences, options_.channel);
        !written)
      return tl::unexpected(NotInvestigated{ExitCode::io, written.error()});
    if (result_.last.verdict == Verdict::unexplained)
      return end(InvestigationEnd::unexplained,
                 "the extended model has an error that none of the known causes explains");
    if (result_.last.verdict == Verdict::partly_explained)
      return end(InvestigationEnd::unexplained,
                 "in addition to the named causes, an error remains that none of the known causes explains");
    if (result_.last.verdict != Verdict::ambiguous) return end(InvestigationEnd::settled, "");
    const auto& gauge_check = consequences.experiment.gauge_check;
    if (!consequences.experiment.best && gauge_check && options_.take_gauge)
      return check_sensor(*gauge_check, folder);
    if (!consequences.experiment.best) return end_without_experiment(consequences.experiment);
    return play(consequences.experiment, folder);
  }

  bool end(InvestigationEnd how, const std::string& why) {
    result_.end = how;
    result_.why = why;
    return false;
  }
  bool end(const NotPlayed& why) {
    result_.code = why.code;
    return end(why.stopped ? InvestigationEnd::stopped : InvestigationEnd::failed, why.why);
  }

  /// Sets the reason for the end if the diagnosis proposed no experiment. The reason is that the budget is
  /// too small, or that no experiment separates the causes.
  bool end_without_experiment(const sysid::NextExperiment& none) {
    sysid::ExperimentOptions unbounded = plan_;
    unbounded.most_minutes = 1e9;
    if (sysid::design_experiment(result_.last, unbounded).best) {
      return end(InvestigationEnd::budget_spent,
                 "the experiments that separate the remaining causes take longer than the remaining time");
    }
    std::string why = "none of the remaining experiments separates the remaining causes";
    for (const std::string& sentence : none.advice) why += ". " + sentence;
    return end(InvestigationEnd::nothing_left, why);
  }

  bool play(const sysid::NextExperiment& experiment, const std::string& folder) {
    InvestigationStep& step = result_.steps.back();
    const sysid::JudgedWaveform& best = *experiment.best;
    tell("playing " + best.waveform.name + ", " + significant(best.minutes, 2) +
         " minutes: " + significant(experiment.predicted_separation_sigma, 3) +
         " standard deviations of predicted separation between the causes");
    auto log = options_.play(experiment, folder);
    if (!log) return end(log.error());
    if (options_.diagnosis.record.drive == sysid::Drive::measured && log->pressure_kpa.empty())
      return end(InvestigationEnd::failed,
                 "the rig did not measure the pressure, but the measured pressure is the input of the model");
    step.experiment = best.waveform.name;
    step.predicted_separation_sigma = experiment.predicted_separation_sigma;
    step.minutes = best.minutes;
    step.log = log->path;
    step.answer = sysid::validate_logs(result_.last.extended_model, {*log}, options_.diagnosis.record);
    result_.spent_minutes += best.minutes;
    if (const auto why = broken_promise(best.waveform, *log))
      return end(InvestigationEnd::not_as_asked, *why);
    if (const auto why = contact_in(*log)) return end(InvestigationEnd::contact, *why);
    plan_.done.push_back(best.waveform.name);
    result_.logs.push_back(std::move(*log));
    return true;
  }

  /// Returns a sentence if the log shows a contact. Returns nullopt if the diagnosis already names contact as
  /// a cause or an alternative.
  [[nodiscard]] std::optional<std::string> contact_in(const sysid::Log& log) const {
    for (const sysid::NamedCause& named : result_.last.causes) {
      const auto is_contact = [](const sysid::Cause& cause) {
        return cause.id == sysid::causes::Contact::id;
      };
      if (is_contact(named.cause) ||
          std::any_of(named.alternatives.begin(), named.alternatives.end(), is_contact))
        return std::nullopt;
    }
    return touched(*result_.steps.back().answer, log, sysid::campaign_size(result_.last.records).largest_kpa);
  }

  /// Checks the sensor against a gauge. The check is needed if the alternatives differ in the sensor alone,
  /// because no waveform separates such alternatives.
  bool check_sensor(const sysid::ProposedGaugeCheck& check, const std::string& folder) {
    if (check.minutes > result_.budget_minutes - result_.spent_minutes) {
      return end(InvestigationEnd::budget_spent,
                 "the sensor must be checked against a gauge, which takes longer than the remaining time");
    }
    tell("checking the sensor against a gauge: " + std::to_string(check.positions_mm.size()) + " readings, " +
         significant(check.minutes, 2) + " minutes");
    auto gauge = options_.take_gauge(check.positions_mm, folder);
    if (!gauge) return end(gauge.error());
    InvestigationStep& step = result_.steps.back();
    step.experiment = gauge_check_name;
    step.minutes = check.minutes;
    step.log = gauge->path;
    result_.spent_minutes += check.minutes;
    result_.gauge = std::move(*gauge);
    return true;
  }

  void tell(const std::string& line) const {
    if (options_.tell) options_.tell(line);
  }

  const InvestigationOptions& options_;
  sysid::ExperimentOptions plan_;
  Investigation result_;
};

}  // namespace

std::string_view name_of(InvestigationEnd end) noexcept {
  static constexpr auto names =
      enum_names<InvestigationEnd>({{InvestigationEnd::settled, "settled"},
                                    {InvestigationEnd::unexplained, "unexplained"},
                                    {InvestigationEnd::nothing_left, "nothing_left"},
                                    {InvestigationEnd::budget_spent, "budget_spent"},
                                    {InvestigationEnd::contact, "contact"},
                                    {InvestigationEnd::not_as_asked, "not_as_asked"},
                                    {InvestigationEnd::stopped, "stopped"},
                                    {InvestigationEnd::failed, "failed"}});
  return names[end];
}

tl::expected<Investigation, NotInvestigated> investigate(const InvestigationOptions& options) {
  return Investigator(options).run();
}

Fields fields_of(const InvestigationStep& step) {
  const bool has_experiment = !step.experiment.empty();
  const bool separates = has_experiment && step.experiment != gauge_check_name;
  const Value separation =
      number(separates ? std::optional(step.predicted_separation_sigma) : std::nullopt, 3);
  const Value minutes = number(has_experiment ? std::optional(step.minutes) : std::nullopt, 2);
  const Fields experiment{{"waveform", step.experiment},
                          {"predicted_separation_sigma", separation},
                          {"minutes", minutes},
                          {"log", step.log}};
  return {{"folder", "step", step.folder},
          {"verdict", "verdict", sysid::name_of(step.verdict)},
          {"sentence", step.sentence},
          {"heldout_rmse_mm",
           Fields{{"recalibrated", step.recalibrated_rmse_mm}, {"extended", step.extended_rmse_mm}}},
          {"causes", "causes", shown(step.causes, causes_of(step))},
          {"alternatives", result::list_of(step.alternatives, std::identity())},
          {"", "held-out RMSE, refitted [mm]", number(step.recalibrated_rmse_mm, 3)},
          {"", "extended [mm]", number(step.extended_rmse_mm, 3)},
          {"experiment", "next experiment",
           has_experiment ? shown(experiment, step.experiment) : shown(Value(), "-")},
          {"", "predicted separation [standard deviations]", separation},
          {"", "rig time [min]", minutes}};
}

Fields fields_of(const Investigation& investigation, const std::string& rig) {
  const auto of_file = [](const auto& file) -> Fields {
    return {{"path", file.path}, {"sha256", file.sha256}};
  };
  const auto& steps = investigation.steps;
  return {{"schema", 1},
          {"rig", rig},
          {"end", name_of(investigation.end)},
          {"why", investigation.why},
          {"verdict", sysid::name_of(investigation.last.verdict)},
          {"budget_minutes", investigation.budget_minutes},
          {"spent_minutes", investigation.spent_minutes},
          {"causes", steps.empty() ? std::vector<std::string>() : steps.back().causes},
          {"steps", result::list_of(steps)},
          {"logs", result::list_of(investigation.logs, of_file)},
          {"gauge", result::or_null(investigation.gauge, of_file)}};
}

}  // namespace softgrip::tools
