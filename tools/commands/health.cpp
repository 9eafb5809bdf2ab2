// softgrip health: reports which fingers have changed, based on the recordings of normal operation.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "base/clock.h"
#include "base/files.h"
#include "base/result/result.h"
#include "sysid/health/health_result.h"
#include "tools/command_line/command.h"
#include "tools/command_line/options.h"
#include "tools/command_line/output.h"
#include "tools/commands/commands.h"

namespace softgrip::tools {
namespace {

namespace fs = std::filesystem;
namespace health = sysid::health;

struct HealthOptions {
  std::vector<std::string> runs;
  std::string baseline;
  std::string notes;
  std::string out;
  health::HealthOptions judge;
  std::string points = "day";
  bool json = false;
};

tl::expected<std::vector<health::Note>, ExitCode> notes_of(const HealthOptions& options) {
  std::string path = options.notes;
  if (path.empty() && !options.out.empty()) {
    const fs::path beside = fs::path(options.out) / "notes.yaml";
    if (is_there(beside)) path = beside.string();
  }
  if (path.empty()) return std::vector<health::Note>{};
  document::Problems problems;
  auto notes = health::load_notes(path, problems);
  if (!notes)
    return tl::unexpected(notes.error().empty() ? refuse(problems) : fail(ExitCode::io, notes.error()));
  return *std::move(notes);
}

/// Prints the reasons why baselines or notes were refused and returns the exit code.
ExitCode refuse_inputs(const health::HealthRefusal& refusal) {
  if (!refusal.notes.empty()) return refuse(refusal.notes);
  ExitCode code = ExitCode::input_refused;
  for (const health::RefusedBaseline& baseline : refusal.baselines) {
    const ExitCode refused =
        baseline.why.empty() ? refuse(baseline.problems) : fail(ExitCode::input_refused, baseline.why);
    code = baseline.unreadable ? ExitCode::io : refused;
  }
  return code;
}

void print(const health::JudgedFinger& finger) {
  const health::FingerHealth& health = finger.health;
  const std::string prefix = health.finger.empty() ? "" : health.finger + ": ";
  std::printf("%s%s\n", prefix.c_str(), health_sentence(health, finger.suspicion).c_str());
  for (const health::HealthAlarm& alarm : health.standing()) {
    std::printf("  detected %s, %zu grips after the change began: %s\n",
                health.points[alarm.noticed].label.c_str(), alarm.grips,
                std::string(sysid::info_of(alarm.number).id).c_str());
  }
  for (const health::Suspect& suspect : finger.suspicion.suspects) {
    std::printf("  %s\n", suspect.id.c_str());
    for (const std::string& step : suspect.next_steps) std::printf("      - %s\n", step.c_str());
  }
  for (const std::string& advice : finger.suspicion.advice) std::printf("  - %s\n", advice.c_str());
  if (!finger.suspicion.suspects.empty())
    std::printf("  to confirm the cause, record the commissioning experiment again:\n      %s\n",
                health::settling_command(finger.source.baseline).c_str());
}

tl::expected<void, std::string> write_results(const std::string& out, const health::RecordedHealth& rig,
                                              const std::string& json) {
  const auto write = [&](const std::string& name, const std::string& text) {
    return write_file((fs::path(out) / name).string(), text);
  };
  if (auto written = write(health::scores_file, rig.scores); !written) return written;
  for (const health::JudgedFinger& finger : rig.fingers) {
    const std::string page =
        finger.health.finger.empty() ? "health.html" : "health-" + finger.health.finger + ".html";
    if (auto written = write(page, health_page(finger.health, finger.suspicion, finger.source).to_html());
        !written)
      return written;
  }
  return write(health::health_file, json);
}

ExitCode run(const HealthOptions& chosen) {
  HealthOptions options = chosen;
  std::vector<std::string> inputs = options.runs;
  inputs.insert(inputs.end(), {options.notes, options.baseline + "/baseline.json"});
  if (const auto code = refuse_overwriting(
          files_in(options.out, {health::scores_file, health::health_file, "health*.html"}), inputs))
    return *code;
  options.judge.by_day = options.points == "day";
  auto notes = notes_of(options);
  if (!notes) return notes.error();
  health::HealthQuestion question{options.runs, options.baseline, *std::move(notes), options.judge, {}};
  if (!options.out.empty()) {
    if (const auto ready = prepare_folder(options.out); !ready) return fail(ExitCode::io, ready.error());
    const std::string path = (fs::path(options.out) / health::scores_file).string();
    auto earlier = health::earlier_scores(path);
    if (!earlier) return fail(ExitCode::io, earlier.error());
    question.scores = *std::move(earlier);
  }
  const auto rig = health::recorded_health(question);
  if (!rig) return refuse_inputs(rig.error());
  for (const health::SkippedRun& skipped : rig->skipped) {
    const std::string& name = skipped.finger.empty() ? skipped.run : skipped.finger;
    std::fprintf(stderr, "softgrip: %s is skipped: %s\n", name.c_str(), skipped.why.c_str());
  }
  if (rig->fingers.empty())
    return fail(rig->incomplete() ? ExitCode::io : ExitCode::input_refused,
                "no recording can be compared with " + options.baseline);
  const std::string json = result::json_text(health::fields_of(*rig, wall_time_now()));
  if (!options.out.empty()) {
    if (const auto written = write_results(options.out, *rig, json); !written)
      return fail(ExitCode::io, written.error());
  }
  if (options.json) {
    std::fputs(json.c_str(), stdout);
  } else {
    for (const health::JudgedFinger& finger : rig->fingers) print(finger);
    for (const std::string& warning : health::warnings_of(*rig)) std::printf("%s\n", warning.c_str());
  }
  if (rig->incomplete()) return ExitCode::io;
  return rig->alarm() ? ExitCode::not_acceptable : ExitCode::done;
}

}  // namespace

void add_health(CLI::App& program, ExitCode& outcome) {
  const auto [command, options] = add_command<HealthOptions>(
      program, outcome, "health",
      "Report which fingers have changed, and since when; uses the recordings of normal operation", run);
  command->add_option("runs", options->runs, "Recordings, or folders of recordings")->required();
  command
      ->add_option("--baseline", options->baseline,
                   "Folder that `softgrip baseline` wrote; if this folder contains one folder for each "
                   "finger, each finger is compared with its own baseline")
      ->required();
  command->add_option("--notes", options->notes, "Maintenance records [notes.yaml in the folder of --out]");
  command->add_option(
      "--out", options->out,
      "Folder for health.json, a page per finger, and the indicators of all recordings so far");
  command
      ->add_option(
          "--points", options->points,
          "Data of one point of a control chart: all grips of a day together, or each grip separately")
      ->check(CLI::IsMember({"day", "run"}))
      ->capture_default_str();
  command
      ->add_option("--false-alarm-points", options->judge.false_alarm_points,
                   "Mean number of points between two false alarms of a healthy finger (average run length)")
      ->check(number_between(20, 1e9))
      ->capture_default_str();
  command->add_flag("--json", options->json, "Print health.json");
  command->footer(
      "Exit codes: 0 nothing has changed, 6 an alarm is active, 3 notes, baseline or recordings are "
      "refused,\n"
      "4 a file cannot be read or written.");
}

}  // namespace softgrip::tools
