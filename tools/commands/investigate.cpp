// softgrip investigate: diagnoses a model, plays the experiment that separates the possible causes, and
// repeats the diagnosis. Finally extends the model, retunes the gains and, if possible, measures the tracking
// error on the rig.

#include <unistd.h>

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
#include "tools/command_line/input_files.h"
#include "tools/command_line/options.h"
#include "tools/command_line/output.h"
#include "tools/command_line/progress_line.h"
#include "tools/command_line/terminal.h"
#include "tools/commands/commands.h"
#include "tools/commands/rig_to_move.h"
#include "tools/investigation/closed_loop_gain.h"
#include "tools/investigation/diagnosis_folder.h"
#include "tools/investigation/experiment_rig.h"
#include "tools/investigation/investigation.h"
#include "tools/log_input/log_input.h"

namespace softgrip::tools {
namespace {

struct InvestigateOptions {
  std::string model;
  std::vector<std::string> data;
  std::string rig;
  std::string rig_command;
  std::string gauge_command;
  std::string gauge;
  std::string out;
  LogInput logs;
  std::string rig_channel;  ///< channel of the rig; "": the rig channel has the name of the log channel
  sysid::DiagnosisOptions diagnosis;
  double budget_minutes = 30;
  double pressure_max_kpa = 0;  ///< with --rig-command, the largest pressure of experiments [kPa]; 0: the
                                ///< largest pressure in the logs
  double slew_kpa_per_s = 300;
  bool yes = false;
  bool no_closed_loop = false;
  bool json = false;
};

/// Properties of the rig that are estimated from the logs.
struct CampaignScales {
  double largest_kpa = 0;
  double gain_mm_per_kpa = 0;
  double interval_s = 0.01;
  bool pressure_recorded = false;
};

CampaignScales scales_of(const std::vector<sysid::Log>& logs) {
  CampaignScales scales;
  scales.largest_kpa = sysid::largest_command_kpa(logs);
  double highest_mm = 0;
  for (const sysid::Log& log : logs) {
    for (const double y : log.displacement_mm) highest_mm = std::max(highest_mm, std::abs(y));
    scales.pressure_recorded |= !log.pressure_kpa.empty();
  }
  scales.interval_s = sysid::sampling_of(logs.front()).median_interval_s;
  if (scales.largest_kpa > 0) scales.gain_mm_per_kpa = highest_mm / scales.largest_kpa;
  return scales;
}

/// The rig on which experiments are played, and its limits.
struct Playground {
  Player play;
  GaugeTaker take_gauge;  ///< empty: neither a person nor a program can move the sensor's target
  sysid::RigLimits limits;
  std::string name;
  std::string channel;
  std::optional<ExperimentRig> rig;  ///< the rig of the rig file, on which the closed loop can be measured;
                                     ///< nullopt: the rig is a program (--rig-command)
};

tl::expected<Playground, ExitCode> playground_of(const InvestigateOptions& options,
                                                 const CampaignScales& scales) {
  Playground ground;
  if (!options.rig_command.empty()) {
    const double largest_kpa = options.pressure_max_kpa > 0 ? options.pressure_max_kpa : scales.largest_kpa;
    ground.limits = {largest_kpa, options.slew_kpa_per_s};
    ground.play = command_player(options.rig_command, scales.interval_s, consent_on_terminal(options.yes));
    if (!options.gauge_command.empty())
      ground.take_gauge = command_gauge(options.gauge_command, consent_on_terminal(options.yes));
    ground.name = options.rig_command;
    return ground;
  }
  auto rig = rig_to_move(
      options.rig, options.rig_channel.empty() ? options.logs.channel : options.rig_channel, options.yes);
  if (!rig) return tl::unexpected(rig.error());
  ground.limits = rig->limits(scales.gain_mm_per_kpa, scales.largest_kpa);
  ground.channel = rig->channel_name();
  ground.name = options.rig;
  ground.rig = *rig;
  if (rig->simulated) {
    ground.take_gauge = simulated_gauge(*rig);
  } else if (::isatty(STDIN_FILENO) == 1) {
    ground.take_gauge = gauge_by_hand(*rig, consent_on_terminal(options.yes));
  }
  ground.play = rig_player(std::move(*rig), consent_on_terminal(options.yes));
  return ground;
}

/// Measures the benefit of the extended model on the rig. If the measurement is impossible, prints the reason
/// and returns nullopt. In this case, the command continues without the measurement.
std::optional<RigTracking> on_rig(const InvestigateOptions& options, const Playground& ground,
                                  const Investigation& investigation,
                                  const std::optional<ClosedLoopGain>& gain) {
  if (!gain || !ground.rig || investigation.end != InvestigationEnd::settled) return std::nullopt;
  const auto tracking =
      track_on_rig(*ground.rig, investigation.last.recalibrated_model, investigation.last.extended_model,
                   *gain, options.out, consent_on_terminal(options.yes));
  if (tracking) return *tracking;
  std::fprintf(stderr, "the closed loop was not measured on the rig: %s\n", tracking.error().why.c_str());
  return std::nullopt;
}

std::string completed(const Investigation& investigation, const Playground& ground,
                      const std::optional<ClosedLoopGain>& gain, const std::optional<RigTracking>& tracking) {
  result::Fields fields = fields_of(investigation, ground.name);
  if (gain) {
    result::Fields closed_loop = fields_of(*gain);
    if (tracking) closed_loop.emplace_back("on_rig", fields_of(*tracking));
    fields.emplace_back("closed_loop", std::move(closed_loop));
  }
  return result::json_text(fields);
}

void print_end(const Investigation& investigation, const std::optional<ClosedLoopGain>& gain,
               const std::string& out) {
  std::printf("\n%s\n", sysid::verdict_sentence(investigation.last).c_str());
  std::printf("%s after %s of %s minutes on the rig%s%s\n", std::string(name_of(investigation.end)).c_str(),
              significant(investigation.spent_minutes, 3).c_str(),
              significant(investigation.budget_minutes, 3).c_str(), investigation.why.empty() ? "" : ": ",
              investigation.why.c_str());
  if (gain) std::fputs(on_screen(text_of({{}, gain}, out)).c_str(), stdout);
  std::printf("report: %s\n", (std::filesystem::path(out) / "report.html").c_str());
}

ExitCode exit_code_of(const Investigation& investigation) {
  switch (investigation.end) {
    case InvestigationEnd::settled:
      return ExitCode::done;
    case InvestigationEnd::stopped:
    case InvestigationEnd::failed:
      return fail(investigation.code, investigation.why);
    case InvestigationEnd::contact:
    case InvestigationEnd::not_as_asked:
    case InvestigationEnd::unexplained:
    case InvestigationEnd::nothing_left:
    case InvestigationEnd::budget_spent:
      return ExitCode::not_acceptable;
  }
  return ExitCode::failed;
}

/// Extends the model, retunes the gains, measures the benefit of the extended model, and writes the results.
ExitCode conclude(const InvestigateOptions& options, const model::Model& given, const Playground& ground,
                  const Investigation& investigation) {
  ConsequenceOptions wanted;
  wanted.experiment.most_minutes = 0;  // no new search, because the last step has already searched for an
                                       // experiment
  wanted.closed_loop = !options.no_closed_loop && investigation.end != InvestigationEnd::stopped;
  wanted.seed = options.diagnosis.seed;
  const Consequences consequences = consequences_of(investigation.last, wanted);
  if (const auto written = write_diagnosis_folder(
          options.out, investigation.last, {investigation.logs, given, {}}, consequences, ground.channel);
      !written) {
    return fail(ExitCode::io, written.error());
  }
  const auto tracking = on_rig(options, ground, investigation, consequences.closed_loop);
  const std::string json = completed(investigation, ground, consequences.closed_loop, tracking);
  const std::string path = (std::filesystem::path(options.out) / "investigation.json").string();
  const std::string page = (std::filesystem::path(options.out) / "report.html").string();
  const std::string closed_loop = consequences.closed_loop ? text_of({{}, consequences.closed_loop}, "") : "";
  for (const auto& [file, text] :
       {std::pair{path, json}, {page, investigation_html(investigation, ground.name, closed_loop)}}) {
    if (const auto written = write_file(file, text); !written) return fail(ExitCode::io, written.error());
  }
  if (options.json) {
    std::fputs(json.c_str(), stdout);
  } else {
    print_end(investigation, consequences.closed_loop, options.out);
    if (tracking) {
      std::printf("on the rig: refitted model %s mm, extended model %s mm\n",
                  significant(tracking->recalibrated_rmse_mm, 3).c_str(),
                  significant(tracking->extended_rmse_mm, 3).c_str());
    }
  }
  return exit_code_of(investigation);
}

ExitCode run(const InvestigateOptions& options) {
  if (options.rig.empty() == options.rig_command.empty())
    return fail(ExitCode::usage, "an investigation needs either --rig or --rig-command");
  if (!options.rig_channel.empty() && options.rig.empty())
    return fail(ExitCode::usage, "--rig-channel needs --rig");
  if (!options.gauge_command.empty() && options.rig_command.empty())
    return fail(ExitCode::usage, "--gauge-command needs --rig-command");
  std::vector<std::string> inputs = options.data;
  inputs.insert(inputs.end(), {options.model, options.rig, options.gauge});
  std::vector<std::string> names = diagnosis_files();
  names.insert(names.end(), {"investigation.json", "report.html", "step_*/*"});
  if (const auto code = refuse_overwriting(files_in(options.out, names), inputs)) return *code;
  const auto model = read_rig_model(options.model);
  if (!model) return model.error();
  const auto logs = read_logs(options.data, options.logs, unit_of_rigs());
  if (!logs) return logs.error();
  const CampaignScales scales = scales_of(*logs);
  if (!(scales.largest_kpa > 0))
    return fail(
        ExitCode::input_refused,
        "the logs contain no pressure above 0, but experiments are designed only for positive pressures");
  auto ground = playground_of(options, scales);
  if (!ground) return ground.error();

  InvestigationOptions investigation;
  investigation.given = *model;
  investigation.logs = *logs;
  investigation.diagnosis = options.diagnosis;
  investigation.diagnosis.record = options.logs.record_options();
  investigation.experiment.limits = ground->limits;
  investigation.experiment.pressure_recorded = scales.pressure_recorded;
  investigation.experiment.threads = options.diagnosis.threads;
  investigation.budget_minutes = options.budget_minutes;
  investigation.out = options.out;
  investigation.channel = ground->channel;
  investigation.play = ground->play;
  investigation.take_gauge = ground->take_gauge;
  if (!options.gauge.empty()) {
    auto gauge = read_gauge(options.gauge, unit_of_rigs());
    if (!gauge) return gauge.error();
    investigation.diagnosis.gauge = std::move(*gauge);
  }
  if (!options.json) {
    investigation.tell = [](const std::string& line) {
      std::printf("%s\n", line.c_str());
      std::fflush(stdout);
    };
  }
  const auto result = [&] {
    ProgressLine line;
    investigation.diagnosis.progress = line.show();
    return investigate(investigation);
  }();
  if (!result) return fail(result.error().code, result.error().why);
  return conclude(options, *model, *ground, *result);
}

}  // namespace

void add_investigate(CLI::App& program, ExitCode& outcome) {
  const auto [command, options] = add_command<InvestigateOptions>(
      program, outcome, "investigate",
      "Run the experiments that separate ambiguous causes, until one cause remains", run);
  command->add_option("--model", options->model, "Model file in use")->required();
  command->add_option("--data", options->data, "Logs of one measurement campaign, in order")->required();
  command->add_option("--rig", options->rig, "Rig file of the rig that is moved");
  command->add_option("--rig-channel", options->rig_channel,
                      "With --rig: the channel to move [the channel given by --channel]");
  command->add_option("--rig-command", options->rig_command,
                      "Program that runs an experiment on a rig that is not controlled by softgripd; called "
                      "as COMMAND COMMAND_CSV LOG_OUT");
  command->add_option("--gauge-command", options->gauge_command,
                      "With --rig-command: program that checks the sensor against a gauge; called as COMMAND "
                      "POSITIONS_CSV GAUGE_OUT");
  command->add_option("--gauge", options->gauge, "An existing gauge file (CSV: gauge_mm,displacement_mm)");
  command->add_option("--out", options->out, "Folder for all results")->required();
  command
      ->add_option("--budget-minutes", options->budget_minutes,
                   "Longest total duration of the experiments on the rig")
      ->check(number_between(0, 1e6))
      ->capture_default_str();
  command
      ->add_option("--pressure-max-kpa", options->pressure_max_kpa,
                   "With --rig-command: highest pressure of the rig [the highest pressure in the logs]")
      ->check(positive_number());
  command->add_option("--slew-kpa-per-s", options->slew_kpa_per_s, "With --rig-command: slew rate of the rig")
      ->check(positive_number())
      ->capture_default_str();
  command->add_flag("--yes", options->yes, "Move the rig without a confirmation question");
  command->add_flag("--no-closed-loop", options->no_closed_loop,
                    "Do not tune the controller for the extended model, and do not measure the closed loop");
  add_search_options(*command, options->diagnosis.seed, options->diagnosis.threads);
  add_log_options(*command, options->logs);
  command->add_flag("--json", options->json, "Print investigation.json");
}

}  // namespace softgrip::tools
