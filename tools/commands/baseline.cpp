// softgrip baseline: writes the baseline of a healthy finger, from a new recording or from existing logs, or
// checks a baseline.

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "base/clock.h"
#include "base/json.h"
#include "base/numbers.h"
#include "base/sha256.h"
#include "base/version.h"
#include "sysid/changes/baseline_folder.h"
#include "sysid/changes/change.h"
#include "sysid/identification/validate.h"
#include "sysid/structure/identify_structure.h"
#include "tools/baseline/commissioning_run.h"
#include "tools/command_line/input_files.h"
#include "tools/command_line/options.h"
#include "tools/command_line/output.h"
#include "tools/command_line/progress_line.h"
#include "tools/commands/baseline_folder.h"
#include "tools/commands/commands.h"
#include "tools/commands/rig_to_move.h"
#include "tools/log_input/log_input.h"

namespace softgrip::tools {
namespace {

using Json = nlohmann::ordered_json;

struct BaselineOptions {
  std::vector<std::string> data;
  std::vector<std::string> check;
  std::string rig;
  std::string rig_channel;  ///< channel of the rig; "": the channel that --channel states
  std::vector<std::string> experiments = usual_commissioning();
  double rest_s = CommissioningOptions{}.rest_s;
  std::string gauge;
  std::string model;
  std::string out;
  LogInput logs;
  std::uint64_t seed = 1;
  unsigned threads = 0;
  bool yes = false;
  bool json = false;
};

/// Logs of a healthy finger: a first run and, if recorded, a second run.
struct Runs {
  std::vector<sysid::Log> healthy, again;
  BaselineContents contents;
  Json rig;  ///< description of the rig on which the logs were recorded; null: the logs come from files
};

tl::expected<model::Model, ExitCode> model_of(const BaselineOptions& options,
                                              const std::vector<sysid::Log>& logs) {
  if (!options.model.empty()) {
    auto model = read_model(options.model);
    if (!model || model->output_unit == logs.front().output_unit) return model;
    return tl::unexpected(fail(ExitCode::input_refused, options.model + " is in " +
                                                            std::string(name_of(model->output_unit)) +
                                                            ", but the logs are in " +
                                                            std::string(name_of(logs.front().output_unit))));
  }
  ProgressLine line;
  sysid::IdentifyOptions fit;
  fit.record = options.logs.record_options();
  fit.seed = options.seed;
  fit.threads = options.threads;
  fit.progress = [show = line.show()](const sysid::Progress& progress) { show(progress.stage); };
  auto identified = sysid::identify_structure(logs, sysid::StructureQuestion::automatic, fit);
  if (!identified) return tl::unexpected(fail(ExitCode::input_refused, identified.error()));
  identified->model.name = "baseline";
  identified->model.source = "softgrip baseline";
  return identified->model;
}

/// Returns the RMS error of a model over all readings of some logs [mm].
double left_mm(const BaselineOptions& options, const model::Model& model,
               const std::vector<sysid::Log>& logs) {
  const sysid::Validation validation = sysid::validate_logs(model, logs, options.logs.record_options());
  double squares = 0, count = 0;
  for (const sysid::Score& score : validation.scores) {
    const auto readings = static_cast<double>(score.error_mm.size());
    squares += readings * score.rmse_mm * score.rmse_mm;
    count += readings;
  }
  return count > 0 ? std::sqrt(squares / count) : 0;
}

/// Compares a second run of the healthy finger with the first run. Returns a JSON null if there is no second
/// run.
tl::expected<Json, ExitCode> checked(const BaselineOptions& options, const Runs& runs,
                                     const model::Model& model, bool& holds) {
  if (runs.again.empty()) return Json(nullptr);
  ProgressLine line;
  sysid::ChangeOptions change{options.logs.held, model, options.seed, options.threads, line.show()};
  const auto diagnosis = sysid::diagnose_change(runs.healthy, runs.again, change);
  if (!diagnosis) return tl::unexpected(fail(ExitCode::input_refused, diagnosis.error()));
  holds = diagnosis->verdict == sysid::ChangeVerdict::unchanged;
  return Json{{"verdict", name_of(diagnosis->verdict)},
              {"sentence", sysid::change_sentence(*diagnosis)},
              {"warnings", diagnosis->warnings},
              {"output_unit", name_of(runs.healthy.front().output_unit)},
              {"healthy_heldout_rms_mm", diagnosis->readings.back().healthy_mm},
              {"second_run_rms_mm", diagnosis->readings.back().later_mm},
              {"model_rmse_mm",
               {{"first_run", left_mm(options, model, runs.healthy)},
                {"second_run", left_mm(options, model, runs.again)}}}};
}

/// Returns the comparison of the two runs as text, with the RMS errors of the model: "The second run: ...".
std::string text_of_check(const Json& check) {
  if (check.is_null())
    return "No second run (--check) was given, so the repeatability of the finger is unknown.";
  const auto number = [](const Json& value) { return significant(value.get<double>(), 3); };
  const std::string unit = " " + check["output_unit"].get<std::string>();
  const Json& model = check["model_rmse_mm"];
  return "The second run: " + check["sentence"].get<std::string>() +
         " Residual of the baseline model: " + number(check["healthy_heldout_rms_mm"]) + unit +
         " on the first run (held out), " + number(check["second_run_rms_mm"]) + unit +
         " on the second run. RMSE of model.yaml, simulated from the command, on the first and the second "
         "run: " +
         number(model["first_run"]) + " and " + number(model["second_run"]) + unit + ".";
}

void print_check(const std::string& what, const Json& check) {
  std::printf("%s %s\n", what.c_str(), text_of_check(check).c_str());
  if (check.is_null()) return;
  for (const Json& warning : check["warnings"])
    std::printf("warning: %s\n", visible_lines(warning.get<std::string>()).c_str());
}

tl::expected<Runs, ExitCode> recorded(const BaselineOptions& options) {
  Runs runs;
  auto healthy = read_logs(options.data, options.logs);
  if (!healthy) return tl::unexpected(healthy.error());
  runs.healthy = std::move(*healthy);
  if (!options.check.empty()) {
    auto again = read_logs(options.check, options.logs, unit_of(runs.healthy));
    if (!again) return tl::unexpected(again.error());
    runs.again = std::move(*again);
  }
  auto files = files_of(runs.healthy);
  auto second = files ? files_of(runs.again) : files;
  if (!second) return tl::unexpected(fail(ExitCode::io, second.error()));
  runs.contents.healthy = std::move(*files);
  runs.contents.second = std::move(*second);
  return runs;
}

/// Returns the files of the baseline folder that contain the logs recorded on the rig. Each experiment gives
/// one log.
std::vector<BaselineFile> files_of_played(const std::vector<sysid::Log>& logs, const std::string& rig) {
  std::vector<BaselineFile> files;
  files.reserve(logs.size());
  for (const sysid::Log& log : logs) files.push_back({log.name + " on " + rig, sysid::format_log(log)});
  return files;
}

tl::expected<Runs, ExitCode> played(const BaselineOptions& options) {
  const auto rig = rig_to_move(
      options.rig, options.rig_channel.empty() ? options.logs.channel : options.rig_channel, options.yes);
  if (!rig) return tl::unexpected(rig.error());
  CommissioningOptions commissioning{
      options.experiments, options.rest_s, consent_on_terminal(options.yes), {}};
  commissioning.tell = [](const std::string& line) { std::fprintf(stderr, "%s\n", line.c_str()); };
  auto result = play_commissioning(*rig, commissioning);
  if (!result) return tl::unexpected(fail(result.error().code, result.error().why));
  Runs runs;
  runs.healthy = std::move(result->first);
  runs.again = std::move(result->second);
  runs.contents.healthy = files_of_played(runs.healthy, options.rig);
  runs.contents.second = files_of_played(runs.again, options.rig);
  const rig::RigFile& file = rig->rig;
  runs.rig = {{"file", options.rig},
              {"sha256", sha256(file.inputs.front().text)},
              {"name", file.name},
              {"channel", rig->channel_name()},
              {"simulated", rig->simulated},
              {"experiments", options.experiments},
              {"rest_s", options.rest_s},
              {"pressure_max_kpa", result->limits.pressure_max_kpa},
              {"slew_kpa_per_s", result->limits.slew_kpa_per_s},
              {"minutes", result->minutes}};
  return runs;
}

ExitCode keep(const BaselineOptions& options, Runs runs, const std::vector<std::string>& call) {
  if (!options.gauge.empty()) {
    if (const auto gauge = read_gauge(options.gauge, unit_of(runs.healthy)); !gauge) return gauge.error();
    auto file = baseline_file(options.gauge);
    if (!file) return fail(ExitCode::io, file.error());
    runs.contents.gauge = std::move(*file);
  }
  const auto model = model_of(options, runs.healthy);
  if (!model) return model.error();
  runs.contents.model = *model;
  bool holds = true;
  const auto check = checked(options, runs, *model, holds);
  if (!check) return check.error();
  Json about{{"schema", 1},
             {"made", utc_text(wall_time_now())},
             {"software_version", std::string(software_version())},
             {"call", call},
             {"output_unit", name_of(runs.healthy.front().output_unit)},
             {"rig", runs.rig},
             {"check", *check}};
  about["noise_mm"] = Json::array();
  for (const sysid::Record& record : sysid::make_records(runs.healthy, options.logs.record_options()))
    about["noise_mm"].push_back(sysid::fast_noise_mm(record));
  const auto text = write_baseline(options.out, runs.contents, std::move(about));
  if (!text) return fail(ExitCode::io, text.error());
  if (options.json) {
    std::fputs(text->c_str(), stdout);
  } else {
    print_check("Baseline of " + std::to_string(runs.healthy.size()) + " logs in " + options.out + ".",
                *check);
  }
  return holds ? ExitCode::done : ExitCode::not_acceptable;
}

/// Checks the files of an existing baseline and repeats the comparison of its second run with its first run.
ExitCode checked_again(BaselineOptions options) {
  const std::string folder = options.check.front();
  if (const auto code = unreadable(folder)) return *code;
  const auto baseline = sysid::read_baseline(folder);
  if (!baseline) return fail(ExitCode::input_refused, baseline.error());
  if (baseline->second.empty())
    return fail(ExitCode::input_refused,
                folder + " contains no second run: record the baseline again with --check or --rig");
  options.data = baseline->logs;
  options.check = baseline->second;
  const auto runs = recorded(options);
  if (!runs) return runs.error();
  const auto model = read_model(baseline->model);
  if (!model) return model.error();
  bool holds = false;
  const auto check = checked(options, *runs, *model, holds);
  if (!check) return check.error();
  if (options.json) {
    std::printf("%s\n", json_dump(Json{{"schema", 1}, {"baseline", folder}, {"check", *check}}, 2).c_str());
  } else {
    print_check("Baseline in " + folder + ": the files of the baseline are unchanged.", *check);
  }
  return holds ? ExitCode::done : ExitCode::not_acceptable;
}

/// Returns true if the output folder contains a baseline or, before a motion, any other file.
bool is_occupied(const BaselineOptions& options) {
  namespace fs = std::filesystem;
  std::error_code none;
  if (options.rig.empty()) return fs::exists(fs::path(options.out) / "baseline.json", none);
  return fs::exists(options.out, none) && !fs::is_empty(options.out, none);
}

/// Returns an exit code if the model or the gauge readings for a rig cannot be used. A rig must not move
/// before this check, because the recorded logs would be lost.
std::optional<ExitCode> refuse_inputs(const BaselineOptions& options) {
  if (options.rig.empty()) return std::nullopt;
  if (!options.model.empty()) {
    if (const auto model = read_rig_model(options.model); !model) return model.error();
  }
  if (!options.gauge.empty()) {
    if (const auto gauge = read_gauge(options.gauge, unit_of_rigs()); !gauge) return gauge.error();
  }
  return std::nullopt;
}

ExitCode run(const BaselineOptions& options, const std::vector<std::string>& call) {
  if (options.data.empty() && options.rig.empty()) {
    if (options.check.size() == 1) return checked_again(options);
    return fail(ExitCode::usage,
                "a new baseline needs --rig or --data; --check DIR alone checks an existing baseline");
  }
  if (options.out.empty()) return fail(ExitCode::usage, "--out is required: the folder of the baseline");
  std::vector<std::string> inputs = options.data;
  inputs.insert(inputs.end(), options.check.begin(), options.check.end());
  inputs.insert(inputs.end(), {options.rig, options.gauge, options.model});
  if (const auto code = refuse_overwriting(files_in(options.out, baseline_files()), inputs)) return *code;
  if (is_occupied(options))
    return fail(ExitCode::state_refused,
                options.out + " already exists and is not changed: give the name of a new folder");
  if (const auto code = refuse_inputs(options)) return *code;
  auto runs = options.rig.empty() ? recorded(options) : played(options);
  if (!runs) return runs.error();
  return keep(options, std::move(*runs), call);
}

/// Adds the options of a baseline that is recorded on a rig.
void add_rig_options(CLI::App& command, BaselineOptions& options) {
  CLI::Option* const data = command.get_option("--data");
  CLI::Option* const rig = command.add_option(
      "--rig", options.rig, "Rig file of the rig on which the commissioning experiment is run twice");
  rig->excludes(data)->excludes(command.get_option("--check"));
  command
      .add_option("--rig-channel", options.rig_channel,
                  "With --rig: the channel to move [the channel given by --channel]")
      ->needs(rig);
  std::vector<std::string> menu;
  for (const sysid::Waveform& waveform : sysid::experiment_menu({})) menu.push_back(waveform.name);
  command
      .add_option("--experiments", options.experiments,
                  "With --rig: names of the experiments that the rig runs")
      ->needs(rig)
      ->check(CLI::IsMember(menu))
      ->capture_default_str();
  command
      .add_option(
          "--rest-s", options.rest_s,
          "With --rig: duration of the rest at zero pressure before each experiment, in which creep decays")
      ->needs(rig)
      ->check(number_between(0, 3600))
      ->capture_default_str();
  command.add_flag("--yes", options.yes, "Move the rig without a confirmation question")->needs(rig);
}

}  // namespace

void add_baseline(CLI::App& program, ExitCode& outcome) {
  const auto [command, options] = add_command<BaselineOptions>(
      program, outcome, "baseline", "Record a healthy finger as the reference for change detection", run);
  command->add_option("--data", options->data, "Logs of the healthy finger, in order");
  command->add_option(
      "--check", options->check,
      "Logs of a second run of the healthy finger; the exit code is 6 if the finger has changed between the "
      "two runs. Without --data and --rig: folder of the existing baseline that is checked");
  add_rig_options(*command, *options);
  command->add_option(
      "--gauge", options->gauge,
      "File with readings of the sensor at positions that a gauge measured; a copy is stored with the logs");
  command->add_option("--model", options->model, "Model file of the finger [identified from the logs]");
  command->add_option("--out", options->out, "Folder for the logs, model.yaml and baseline.json");
  add_search_options(*command, options->seed, options->threads);
  add_log_options(*command, options->logs);
  command->add_flag("--json", options->json, "Print baseline.json");
}

}  // namespace softgrip::tools
