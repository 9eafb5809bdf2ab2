// softgrip diagnose: finds the error of a model on measured data and its cause. Extends the model and
// measures the benefit of the extension.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/files.h"
#include "base/numbers.h"
#include "sysid/changes/baseline_folder.h"
#include "sysid/diagnosis/report/report.h"
#include "sysid/diagnosis/report/report_sections.h"
#include "sysid/diagnosis/verdict/diagnosis.h"
#include "tools/command_line/command.h"
#include "tools/command_line/input_files.h"
#include "tools/command_line/options.h"
#include "tools/command_line/output.h"
#include "tools/command_line/progress_line.h"
#include "tools/command_line/terminal.h"
#include "tools/commands/commands.h"
#include "tools/commands/diagnose_change.h"
#include "tools/commands/series_output.h"
#include "tools/figures/figure_files.h"
#include "tools/investigation/diagnosis_folder.h"
#include "tools/log_input/log_input.h"

namespace softgrip::tools {
namespace {

/// Largest number of parameters of a cause for which all parameters are printed. If a cause has more
/// parameters, those that the logs do not determine are omitted.
constexpr std::size_t most_undetermined = 5;

struct DiagnoseOptions {
  std::string model;
  std::vector<std::string> data;
  std::vector<std::string> healthy;
  std::string baseline;
  bool explain = false;
  std::string out;
  std::string figures;
  std::string gauge;
  LogInput logs;
  sysid::DiagnosisOptions diagnosis;
  ConsequenceOptions consequences;
  double pressure_max_kpa = 0;  ///< largest pressure of the next experiment [kPa]; 0: the largest pressure in
                                ///< the logs
  double slew_kpa_per_s = 300;
  bool no_closed_loop = false;
  bool json = false;
};

/// Runs the diagnosis of the logs and shows its progress.
tl::expected<sysid::Diagnosis, std::string> diagnosed(const std::vector<sysid::Log>& logs,
                                                      const model::Model& model,
                                                      sysid::DiagnosisOptions options) {
  ProgressLine line;
  options.progress = line.show();
  auto diagnosis = sysid::diagnose(logs, model, options);
  if (diagnosis) sysid::examine(*diagnosis, options);
  return diagnosis;
}

/// Computes the next experiment and simulates the closed loop, and shows the progress of both computations.
Consequences followed(const sysid::Diagnosis& diagnosis, const ConsequenceOptions& options) {
  ProgressLine line;
  line.show()("simulates experiments and the closed loop");
  return consequences_of(diagnosis, options);
}

void print_cause(const sysid::NamedCause& named) {
  if (named.only_in_loop) {
    std::printf("  %-26s found from one-step predictions; held-out error reduction not measured\n",
                std::string(named.cause.id).c_str());
  } else {
    std::printf("  %-26s held-out error reduction %s %% (95 %%: %s to %s)\n",
                std::string(named.cause.id).c_str(), fixed(named.gain_percent.value, 1).c_str(),
                fixed(named.gain_percent.lower, 1).c_str(), fixed(named.gain_percent.upper, 1).c_str());
  }
  std::size_t undetermined = 0;
  for (const sysid::CauseParameter& p : named.parameters) {
    // If a cause has many parameters, print only those that the logs determine.
    if (named.parameters.size() > most_undetermined && !p.determined()) {
      ++undetermined;
      continue;
    }
    const std::string interval = p.has_interval ? "(" + sysid::text_of(p.ci95, p.value, " .. ") + ")" : "";
    std::printf("      %-22s %s %s\n", p.name.c_str(), significant(p.value, 5).c_str(), interval.c_str());
  }
  if (undetermined > 0)
    std::printf(
        "      %zu parameters cannot be determined from these logs; they are listed in diagnosis.json\n",
        undetermined);
  for (const sysid::Cause& alternative : named.alternatives) {
    std::printf("      alternative cause: %s explains the data equally well\n",
                std::string(alternative.id).c_str());
  }
}

void print_summary(const sysid::Diagnosis& d, const std::string& out) {
  std::printf("%s\n\n", sysid::verdict_sentence(d).c_str());
  for (const auto& [term, value] : result::terms_of(sysid::fields_of(d)))
    std::printf("  %-34s %s\n", term.c_str(), value.c_str());
  std::puts("");
  if (d.evidence && d.unexplained_recalibrated.present)
    std::printf("%s\n", sysid::dependence_sentence(d.evidence->recalibrated).c_str());
  for (const sysid::NamedCause& named : d.causes) print_cause(named);
  if (d.in_valve && !d.in_valve->named.empty()) {
    std::puts("  Valve, from command to measured pressure:");
    for (const sysid::NamedCause& named : d.in_valve->named) print_cause(named);
  }
  if (!d.partial.empty())
    std::puts(d.loop_bands_kpa
                  ? "  Explanations from simulations, not reported as the cause, because the test "
                    "of the closed loop shows that the valve sticks:"
                  : "  Partial explanations, too small to be reported as the cause:");
  for (const sysid::NamedCause& named : d.partial) print_cause(named);
  if (const auto& nulls = d.null_calibration) {
    std::printf(
        "in %zu simulated data sets without a cause, the search named a cause %zu times; p-value of the "
        "error reduction: %s\n",
        nulls->campaigns, nulls->named, significant(nulls->p_value, 2).c_str());
  }
  for (const std::string& warning : d.warnings) std::printf("warning: %s\n", visible_lines(warning).c_str());
  const std::string page = (std::filesystem::path(out) / "report.html").string();
  std::printf("%s s; report: %s\n", significant(d.wall_s, 3).c_str(), visible_lines(page).c_str());
}

void print_comparison(const sysid::Diagnosis& d) {
  std::printf("\n%s", visible_lines(sysid::text_of(sysid::run_table(d))).c_str());
  for (const sysid::Table& table : sysid::candidate_tables(d))
    std::printf("\n%s", sysid::text_of(table).c_str());
  for (const auto& [id, recording] : d.not_tested)
    std::printf("%s was not tested: %s\n", id.c_str(), recording.c_str());
}

ConsequenceOptions consequence_options(const DiagnoseOptions& options, const std::vector<sysid::Log>& logs) {
  ConsequenceOptions wanted = options.consequences;
  sysid::RigLimits limits{options.pressure_max_kpa, options.slew_kpa_per_s};
  for (const sysid::Log& log : logs) wanted.experiment.pressure_recorded |= !log.pressure_kpa.empty();
  if (!(options.pressure_max_kpa > 0))
    limits.pressure_max_kpa = std::max(limits.pressure_max_kpa, sysid::largest_command_kpa(logs));
  wanted.experiment.limits = limits;
  wanted.experiment.threads = options.diagnosis.threads;
  wanted.closed_loop = !options.no_closed_loop && limits.pressure_max_kpa > 0;
  wanted.seed = options.diagnosis.seed;
  return wanted;
}

/// Returns the curves of the closed loop that the report shows. A model without feedforward has no curve.
std::optional<sysid::ClosedLoopCurves> closed_loop_curves(const Consequences& consequences) {
  if (!consequences.closed_loop) return std::nullopt;
  const ClosedLoopGain& gain = *consequences.closed_loop;
  sysid::ClosedLoopCurves curves{
      gain.reference(), gain.pid_alone.trace.time_s, gain.pid_alone.trace.reference_mm, {}, gain.notes(),
      gain.output_unit};
  for (const auto& [name, scheme] :
       {std::pair<const char*, const ClosedLoopScheme*>{"PID alone", &gain.pid_alone},
        {"recalibrated model", &gain.recalibrated},
        {"extended model", &gain.extended}}) {
    if (scheme == &gain.pid_alone || scheme->feedforward != control::FeedforwardKind::none)
      curves.schemes.push_back({name, scheme->rmse_mm, scheme->trace.displacement_mm});
  }
  return curves;
}

/// Reports the change between the healthy logs and the other logs.
ExitCode changed(const DiagnoseOptions& options, const model::Model& model,
                 const std::vector<sysid::Log>& logs, const std::vector<std::string>& call) {
  const auto healthy = read_logs(options.healthy, options.logs, unit_of(model));
  if (!healthy) return healthy.error();
  ChangeQuestion question{*healthy, logs,         model,          {}, options.out, options.figures,
                          call,     options.json, options.explain};
  question.options.held = options.logs.held;
  question.options.seed = options.diagnosis.seed;
  question.options.threads = options.diagnosis.threads;
  return run_change(std::move(question));
}

std::optional<ExitCode> refuse_own_inputs(const DiagnoseOptions& options) {
  std::vector<std::string> inputs = options.data;
  inputs.insert(inputs.end(), options.healthy.begin(), options.healthy.end());
  inputs.insert(inputs.end(), {options.model, options.gauge});
  if (!options.baseline.empty()) inputs.push_back(options.baseline + "/baseline.json");
  return refuse_report(options.out, options.figures, diagnosis_files(), inputs);
}

ExitCode run(const DiagnoseOptions& chosen, const std::vector<std::string>& call) {
  DiagnoseOptions options = chosen;
  if (!options.baseline.empty()) {
    const auto baseline = sysid::read_baseline(options.baseline);
    if (!baseline) {
      const bool there = is_there(options.baseline + "/baseline.json");
      return fail(there ? ExitCode::input_refused : ExitCode::io, baseline.error());
    }
    options.healthy = baseline->logs;
    if (options.model.empty()) options.model = baseline->model;
  }
  if (options.model.empty()) return fail(ExitCode::usage, "--model is required without --baseline");
  if (const auto code = refuse_own_inputs(options)) return *code;
  const auto model = read_model(options.model);
  if (!model) return model.error();
  const auto logs = read_logs(options.data, options.logs, unit_of(*model));
  if (!logs) return logs.error();
  if (!options.healthy.empty()) return changed(options, *model, *logs, call);
  options.diagnosis.record = options.logs.record_options();
  if (!options.gauge.empty()) {
    auto gauge = read_gauge(options.gauge, unit_of(*model));
    if (!gauge) return gauge.error();
    options.diagnosis.gauge = std::move(*gauge);
  }
  auto result = diagnosed(*logs, *model, options.diagnosis);
  if (!result) return fail(ExitCode::input_refused, result.error());

  const Consequences consequences = followed(*result, consequence_options(options, *logs));
  const auto json =
      write_diagnosis_folder(options.out, *result, {*logs, *model, call}, consequences, options.logs.channel);
  if (!json) return fail(ExitCode::io, json.error());
  const sysid::DiagnosisReport report{*result,
                                      *logs,
                                      *model,
                                      options.diagnosis.seed,
                                      consequences.experiment,
                                      closed_loop_curves(consequences)};
  const sysid::Page page = sysid::diagnosis_page(report);
  if (const auto written = write_report(options.out, {}, page, options.figures); !written)
    return fail(ExitCode::io, written.error());
  if (const auto written = write_series(options.out, series_of(*result, *logs)); !written)
    return fail(ExitCode::io, written.error());
  if (options.json) {
    std::fputs(json->c_str(), stdout);
  } else {
    print_summary(*result, options.out);
    if (options.explain) print_comparison(*result);
    std::fputs(on_screen(visible_lines(text_of(consequences, options.out))).c_str(), stdout);
  }
  return ExitCode::done;
}

}  // namespace

void add_diagnose(CLI::App& program, ExitCode& outcome) {
  const auto [command, options] = add_command<DiagnoseOptions>(
      program, outcome, "diagnose", "Find the error of a model on measured data, and the cause of this error",
      run);
  command->add_option("--model", options->model, "Model file in use [the model of the baseline]");
  command
      ->add_option("--data", options->data,
                   "Logs of one measurement campaign, in order (CSV, or a recording's folder)")
      ->required();
  command->add_option("--healthy", options->healthy,
                      "Logs of the healthy finger; the change since these logs is diagnosed");
  command
      ->add_option("--baseline", options->baseline,
                   "Folder that `softgrip baseline` wrote; its logs are used as the healthy logs")
      ->excludes("--healthy");
  command->add_flag(
      "--explain", options->explain,
      "Print how the verdict was reached: tested causes, errors of each run, reasons for rejection");
  command
      ->add_option(
          "--out", options->out,
          "Folder for diagnosis.json, model.yaml, next_experiment.yaml, report.html, and series.csv per log")
      ->required();
  add_figures_option(*command, options->figures);
  command->add_option(
      "--gauge", options->gauge,
      "Readings of the sensor at positions that a gauge measured (CSV: gauge_mm,displacement_mm)");
  command
      ->add_option("--nulls", options->diagnosis.null_campaigns,
                   "Number of simulated data sets without any cause, from which the p-value of the search is "
                   "computed (with 19, the smallest p-value is 0.05)")
      ->check(whole_between(0, 100'000))
      ->capture_default_str();
  add_search_options(*command, options->diagnosis.seed, options->diagnosis.threads);
  command->add_flag("--propose", options->consequences.experiment.always,
                    "Propose an experiment even if no alternative cause remains");
  command
      ->add_option("--pressure-max-kpa", options->pressure_max_kpa,
                   "Highest pressure of the proposed experiment [the highest pressure in the logs]")
      ->check(positive_number());
  // A diagnosis of a change does not use these options.
  for (const char* const name : {"--gauge", "--nulls", "--propose", "--pressure-max-kpa"})
    command->get_option(name)->excludes("--healthy")->excludes("--baseline");
  command
      ->add_option("--slew-kpa-per-s", options->slew_kpa_per_s,
                   "Slew rate of the rig; limits the proposed experiment")
      ->check(positive_number())
      ->capture_default_str();
  command->add_flag("--no-closed-loop", options->no_closed_loop,
                    "Do not simulate the closed loop with the extended model");
  add_log_options(*command, options->logs);
  command->add_flag("--json", options->json, "Print diagnosis.json");
}

}  // namespace softgrip::tools
