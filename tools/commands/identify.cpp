// softgrip identify: estimates the parameters of a model from logs.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/numbers.h"
#include "model/file/model_file.h"
#include "sysid/fitting/score.h"
#include "sysid/identification/identify.h"
#include "sysid/identification/identify_report.h"
#include "sysid/instrument/identified_logs.h"
#include "sysid/pages/page.h"
#include "sysid/structure/structure.h"
#include "tools/command_line/input_files.h"
#include "tools/command_line/options.h"
#include "tools/command_line/output.h"
#include "tools/command_line/progress_line.h"
#include "tools/commands/commands.h"
#include "tools/commands/series_output.h"
#include "tools/figures/figure_files.h"
#include "tools/log_input/log_input.h"

namespace softgrip::tools {
namespace {

struct IdentifyOptions {
  std::vector<std::string> data;
  std::vector<std::string> validate;
  std::string start;
  std::string out;
  std::string figures;
  std::string structure;
  std::size_t branches = 2;
  LogInput logs;
  sysid::IdentifyOptions fit;
  bool json = false;
};

sysid::ShowProgress progress_on(ProgressLine& line, model::OutputUnit output_unit) {
  return [show = line.show(), unit = std::string(name_of(output_unit))](const sysid::Progress& progress) {
    if (!progress.stage.empty()) return show(progress.stage);
    show("start " + std::to_string(progress.done) + " of " + std::to_string(progress.starts) +
         ", best RMSE " + significant(progress.best_rmse_mm, 4) + " " + unit);
  };
}

constexpr const char* automatic = "auto";

/// Returns the set of model structures from which the command chooses one, or nullopt without --structure:
/// the start model or the default model then gives the structure.
std::optional<sysid::StructureQuestion> question_of(const IdentifyOptions& options) {
  using sysid::HysteresisForm, sysid::StructureQuestion;
  if (options.structure == name_of(HysteresisForm::bouc_wen)) return StructureQuestion::bouc_wen;
  if (options.structure == name_of(HysteresisForm::play)) return StructureQuestion::prandtl_ishlinskii;
  if (options.structure == automatic) return StructureQuestion::automatic;
  return std::nullopt;
}

/// Fits the model and shows the progress.
tl::expected<sysid::IdentifiedLogs, std::string> identified(sysid::IdentifyQuestion question) {
  ProgressLine line;
  question.options.progress = progress_on(line, question.logs.front().output_unit);
  return sysid::identify_logs(std::move(question));
}

bool any_diverges(const std::vector<sysid::Score>& scores) {
  return std::any_of(scores.begin(), scores.end(), [](const sysid::Score& s) { return s.diverges; });
}

void print_estimates(const std::vector<sysid::Estimate>& list) {
  for (const sysid::Estimate& e : list) {
    const std::string range = e.ci95 ? sysid::text_of(*e.ci95, e.value, " .. ") : "";
    std::printf("  %-34s %12s  %-26s %s\n", e.name.c_str(), significant(e.value, 5).c_str(), range.c_str(),
                e.note.c_str());
  }
}

void print_scores(const char* title, const std::vector<sysid::Score>& scores) {
  if (scores.empty()) return;
  std::printf("%s\n", title);
  for (const sysid::Score& s : scores) {
    const std::string unit(name_of(s.output_unit));
    std::printf("  %-24s RMSE %8s %s  %6s %% of span  largest %8s %s  driven by the %s\n", s.name.c_str(),
                significant(s.rmse_mm, 4).c_str(), unit.c_str(),
                significant(s.rmse_percent_of_span, 3).c_str(), significant(s.largest_error_mm, 3).c_str(),
                unit.c_str(), name_of(s.drive).c_str());
  }
}

void print_structure(const sysid::StructureEvidence& s, model::OutputUnit output_unit) {
  const std::string unit(name_of(output_unit));
  std::printf("Structures, with the RMSE of the fit and of %zu held-out interleaved blocks\n", s.blocks);
  for (const sysid::StructureEvidence::Candidate& c : s.candidates) {
    std::printf("  %c %-86s %8s  %8s %s\n", c.chosen ? '*' : ' ', c.description.c_str(),
                significant(c.rmse_mm, 4).c_str(), significant(c.heldout_rmse_mm, 4).c_str(), unit.c_str());
  }
  for (const sysid::StructureEvidence::Ablation& a : s.ablation) {
    std::printf("    without %-78s %8s  %8s %s\n", a.without.c_str(), significant(a.rmse_mm, 4).c_str(),
                significant(a.heldout_rmse_mm, 4).c_str(), unit.c_str());
  }
  if (!s.valve) return;
  std::printf(
      "Valve, from command to measured pressure: delay %s s; lag %s s during filling, %s s during venting; "
      "RMSE %s kPa, %s %% of the range\n",
      significant(s.valve->delay_s, 3).c_str(), significant(s.valve->filling_time_constant_s, 3).c_str(),
      significant(s.valve->venting_time_constant_s, 3).c_str(), significant(s.valve->rmse_kpa, 3).c_str(),
      significant(s.valve->rmse_percent_of_range, 2).c_str());
  print_scores("Valve and finger in series, simulated from the command", s.valve->from_command);
}

void print_summary(const sysid::IdentifyReport& report, const std::string& out) {
  const sysid::Identification& r = report.result;
  std::printf("%s\n", sysid::verdict_of(r).c_str());
  for (const std::string& warning : r.warnings) std::printf("warning: %s\n", warning.c_str());
  std::puts("");
  print_scores("Fit", r.scores);
  if (r.structure) print_structure(*r.structure, r.model.output_unit);
  print_scores("Held out, continuation", r.held_out);
  print_scores("Validation", report.validation);
  std::puts("Parameters, 95 % intervals");
  print_estimates(r.parameters);
  print_estimates(r.starts);
  std::puts("Observations");
  print_estimates(r.combinations);
  std::printf("%.0f %% of %zu starts reached the best fit, %s s; report: %s\n",
              100 * r.multistart.share_at_best, r.multistart.starts, significant(r.wall_s, 3).c_str(),
              (std::filesystem::path(out) / "report.html").c_str());
}

ExitCode run(const IdentifyOptions& chosen, const std::vector<std::string>& call) {
  IdentifyOptions options = chosen;
  std::vector<std::string> inputs = options.data;
  inputs.insert(inputs.end(), options.validate.begin(), options.validate.end());
  inputs.push_back(options.start);
  if (const auto code = refuse_report(options.out, options.figures, {"model.yaml", "identify.json"}, inputs))
    return *code;
  LogInput fitted = options.logs;
  fitted.begins_at_measured_pressure = question_of(options).has_value();
  std::optional<model::Model> given;
  if (!options.start.empty()) {
    auto read = read_model(options.start);
    if (!read) return read.error();
    given = std::move(*read);
  }
  auto logs = read_logs(options.data, fitted, given ? std::optional(unit_of(*given)) : std::nullopt);
  if (!logs) return logs.error();
  sysid::IdentifyQuestion question{
      std::move(*logs),     {},         std::move(given), options.start, options.branches,
      question_of(options), options.fit};
  if (!options.validate.empty()) {
    auto read = read_logs(options.validate, options.logs, unit_of(question.logs));
    if (!read) return read.error();
    question.validation = std::move(*read);
  }
  question.options.record = options.logs.record_options();
  const auto all = identified(std::move(question));
  if (!all) return fail(ExitCode::input_refused, all.error());
  const sysid::Identification& result = all->result;
  const sysid::IdentifyReport report = all->report(call);
  const std::string json = sysid::identify_json(report);
  const sysid::Page page = sysid::identify_page(report);
  if (const auto written =
          write_report(options.out, {{"model.yaml", model::to_yaml(result.model)}, {"identify.json", json}},
                       page, options.figures);
      !written)
    return fail(ExitCode::io, written.error());
  std::vector<LogSeries> series = series_of(all->logs, result.records, result.scores, "identified", false);
  for (LogSeries& one :
       series_of(all->validation_logs, all->validation_records, all->validation, "identified", true))
    series.push_back(std::move(one));
  if (const auto written = write_series(options.out, series); !written)
    return fail(ExitCode::io, written.error());
  if (options.json) {
    std::fputs(json.c_str(), stdout);
  } else {
    print_summary(report, options.out);
  }
  const bool diverges =
      any_diverges(result.scores) || any_diverges(result.held_out) || any_diverges(report.validation);
  return result.converged && !diverges ? ExitCode::done : ExitCode::not_acceptable;
}

void add_fit_options(CLI::App& command, sysid::IdentifyOptions& fit) {
  command.add_option("--fix", fit.fixed,
                     "Parameters that are fixed at their start value (example: bouc_wen.gamma_per_kpa)");
  command.add_option("--free", fit.free, "Fit only these parameters, and fix all other parameters");
  command.add_option("--starts", fit.starts, "Number of start points of the search")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  command.add_option("--seed", fit.seed, "Seed of the start points")
      ->check(seed_number())
      ->capture_default_str();
  command
      .add_option("--exponents", fit.exponents, "Exponents of the hysteresis that are fitted and compared")
      ->check(CLI::Range(1, 4));
  command.add_flag("--robust", fit.robust,
                   "Robust fit with Huber loss, which grows only linearly for outliers");
  command.add_flag("--profile", fit.profile, "Also compute confidence intervals by profile likelihood");
  command
      .add_option("--fit-share", fit.fit_share,
                  "Share of each log that is fitted, counted from the start of the log; the rest of the log "
                  "is held out")
      ->check(number_between(0.05, 1.0))
      ->capture_default_str();
  command.add_option("--threads", fit.threads, "Number of threads; 0: one per core")->capture_default_str();
}

/// Adds the option for an automatic choice of the structure. This option cannot be combined with the options
/// of a fit whose structure is given.
void add_structure_option(CLI::App& command, IdentifyOptions& options) {
  using sysid::HysteresisForm;
  const std::vector<std::string> names{automatic, std::string(name_of(HysteresisForm::bouc_wen)),
                                       std::string(name_of(HysteresisForm::play))};
  CLI::Option* const structure =
      command
          .add_option("--structure", options.structure,
                      "Select the model structure by the error on held-out blocks. Type of the hysteresis: " +
                          names[0] + ", " + names[1] + " or " + names[2] +
                          " [the structure of the start model]")
          ->check(CLI::IsMember(names));
  for (const char* other : {"--branches", "--fix", "--free", "--exponents", "--robust", "--profile"})
    structure->excludes(command.get_option(other));
}

}  // namespace

void add_identify(CLI::App& program, ExitCode& outcome) {
  const auto [command, options] = add_command<IdentifyOptions>(
      program, outcome, "identify", "Estimate model parameters from logs, with 95 % intervals", run);
  command->add_option("--data", options->data, "Logs to fit (CSV, or a recording's folder)")->required();
  command->add_option("--validate", options->validate, "Logs to predict");
  command->add_option("--start", options->start, "Model file with the start values [the base structure]");
  command->add_option("--branches", options->branches, "Number of creep branches of the base structure")
      ->check(CLI::Range(1, 8))
      ->capture_default_str();
  command
      ->add_option("--out", options->out,
                   "Folder for model.yaml, identify.json, report.html, and series.csv per log")
      ->required();
  add_figures_option(*command, options->figures);
  add_fit_options(*command, options->fit);
  add_structure_option(*command, *options);
  add_log_options(*command, options->logs);
  command->add_flag("--json", options->json, "Print identify.json");
}

}  // namespace softgrip::tools
