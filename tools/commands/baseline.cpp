// softgrip baseline: what a healthy finger does, kept for the day on which it does not.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/numbers.h"
#include "base/version.h"
#include "base/wall_clock.h"
#include "sysid/changes/change.h"
#include "sysid/structure/identify_structure.h"
#include "tools/command_line/call.h"
#include "tools/command_line/log_input.h"
#include "tools/command_line/model_input.h"
#include "tools/command_line/progress_line.h"
#include "tools/commands/baseline_folder.h"
#include "tools/commands/commands.h"

namespace softgrip::tools {
namespace {

using Json = nlohmann::ordered_json;

struct BaselineOptions {
  std::vector<std::string> data;
  std::vector<std::string> check;
  std::string model;
  std::string out;
  LogInput logs;
  std::uint64_t seed = 1;
  unsigned threads = 0;
  bool json = false;
};

tl::expected<model::Model, ExitCode> model_of(const BaselineOptions& options,
                                              const std::vector<sysid::Log>& logs) {
  if (!options.model.empty()) return read_model(options.model);
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

/// What a second run of the healthy finger says; null: there is none.
tl::expected<Json, ExitCode> checked(const BaselineOptions& options, const std::vector<sysid::Log>& healthy,
                                     const model::Model& model, bool& holds) {
  if (options.check.empty()) return Json(nullptr);
  const auto again = read_logs(options.check, options.logs);
  if (!again) return tl::unexpected(again.error());
  ProgressLine line;
  sysid::ChangeOptions change{options.logs.held, model, options.seed, options.threads, line.show()};
  const auto diagnosis = sysid::diagnose_change(healthy, *again, change);
  if (!diagnosis) return tl::unexpected(fail(ExitCode::input_refused, diagnosis.error()));
  holds = diagnosis->verdict == sysid::ChangeVerdict::unchanged;
  return Json{{"verdict", name_of(diagnosis->verdict)},
              {"sentence", sysid::change_sentence(*diagnosis)},
              {"healthy_heldout_rms_mm", diagnosis->readings.back().healthy_mm},
              {"second_run_rms_mm", diagnosis->readings.back().later_mm}};
}

ExitCode run(const BaselineOptions& options, const std::vector<std::string>& call) {
  const auto logs = read_logs(options.data, options.logs);
  if (!logs) return logs.error();
  const auto model = model_of(options, *logs);
  if (!model) return model.error();
  bool holds = true;
  const auto check = checked(options, *logs, *model, holds);
  if (!check) return check.error();
  Json about{{"schema", 1},
             {"made", utc_text(wall_time_now())},
             {"software_version", std::string(software_version())},
             {"call", call},
             {"check", *check}};
  about["noise_mm"] = Json::array();
  for (const sysid::Record& record : sysid::make_records(*logs, options.logs.record_options()))
    about["noise_mm"].push_back(sysid::fast_noise_mm(record));
  const auto text = write_baseline(options.out, *logs, *model, std::move(about));
  if (!text) return fail(ExitCode::io, text.error());
  if (options.json) {
    std::fputs(text->c_str(), stdout);
  } else {
    std::printf("Baseline of %zu logs in %s. ", logs->size(), options.out.c_str());
    if (check->is_null())
      std::puts("No second run was given (--check): whether the finger repeats itself is not known.");
    else
      std::printf("The second run: %s\n", (*check)["sentence"].get<std::string>().c_str());
  }
  return holds ? ExitCode::done : ExitCode::not_acceptable;
}

}  // namespace

void add_baseline(CLI::App& program, ExitCode& outcome) {
  auto options = std::make_shared<BaselineOptions>();
  CLI::App* command =
      program.add_subcommand("baseline", "Keep what a healthy finger does, to be compared with later");
  command->add_option("--data", options->data, "Logs of the healthy finger, in order")->required();
  command->add_option("--check", options->check,
                      "Logs of a second run of the healthy finger: nothing may have changed (exit 6)");
  command->add_option("--model", options->model, "Model file of the finger [identified from the logs]");
  command->add_option("--out", options->out, "Folder for the logs, model.yaml and baseline.json")->required();
  command->add_option("--seed", options->seed, "Of starts and resampling")->capture_default_str();
  command->add_option("--threads", options->threads, "0: as many as there are cores")->capture_default_str();
  add_log_options(*command, options->logs);
  command->add_flag("--json", options->json, "Print baseline.json");
  command->callback([options, command, &outcome] { outcome = run(*options, call_of(*command)); });
}

}  // namespace softgrip::tools
