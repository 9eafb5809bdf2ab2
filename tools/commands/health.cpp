// softgrip health: what the ordinary recordings of a working day say of the fingers.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/files.h"
#include "base/numbers.h"
#include "base/sha256.h"
#include "base/version.h"
#include "base/wall_clock.h"
#include "sysid/health/health_json.h"
#include "sysid/health/health_page.h"
#include "sysid/health/run_search.h"
#include "tools/command_line/command.h"
#include "tools/command_line/model_input.h"
#include "tools/command_line/output.h"
#include "tools/commands/baseline_folder.h"
#include "tools/commands/commands.h"
#include "tools/log_input/log_input.h"

namespace softgrip::tools {
namespace {

namespace fs = std::filesystem;
namespace health = sysid::health;
using Json = nlohmann::ordered_json;

/// Scores of another kind than before have another name.
constexpr const char* scoring = "1-";
constexpr std::size_t id_letters = 12;
constexpr std::size_t largest_file = std::size_t{512} * 1024 * 1024;

struct HealthOptions {
  std::vector<std::string> runs;
  std::string baseline;
  std::string notes;
  std::string out;
  health::HealthOptions judge;
  std::string points = "day";
  bool json = false;
};

/// A finger of the rig, judged.
struct Judged {
  health::FingerHealth health;
  health::Suspicion suspicion;
  health::HealthSource source;
};

/// DIR/FINGER where that is a baseline, else DIR itself.
class Baselines {
 public:
  explicit Baselines(std::string folder) : folder_(std::move(folder)) {}

  /// Null: it has none. It lives as long as this.
  const health::FingerBase* of(const std::string& finger) {
    const auto [base, is_new] = bases_.try_emplace(finger);
    if (is_new) base->second = read(folder_of(finger));
    return base->second ? &*base->second : nullptr;
  }
  [[nodiscard]] std::string folder_of(const std::string& finger) const {
    const fs::path own = fs::path(folder_) / finger;
    return !finger.empty() && is_there(own / "baseline.json") ? own.string() : folder_;
  }
  /// Why a baseline that is there was refused.
  [[nodiscard]] std::optional<ExitCode> refused() const { return refused_; }

 private:
  std::optional<health::FingerBase> read(const std::string& folder) {
    const std::string file = (fs::path(folder) / "baseline.json").string();
    const auto bytes = read_file(file, largest_file);
    if (!bytes) return std::nullopt;
    const auto baseline = read_baseline(folder);
    if (!baseline) return refuse_with(fail(ExitCode::input_refused, baseline.error()));
    const auto model = read_model(baseline->model);
    if (!model) return refuse_with(model.error());
    const auto logs = read_logs(baseline->logs, {}, unit_of(*model));
    if (!logs) return refuse_with(logs.error());
    const double full_kpa = sysid::largest_command_kpa(*logs);
    if (!(full_kpa > 0))
      return refuse_with(fail(ExitCode::input_refused, folder + ": its logs know no pressure"));
    return health::FingerBase{health::score_base(*model, full_kpa),
                              scoring + sha256(*bytes).substr(0, id_letters)};
  }
  std::nullopt_t refuse_with(ExitCode code) {
    refused_ = code;
    return std::nullopt;
  }

  std::string folder_;
  std::map<std::string, std::optional<health::FingerBase>> bases_;
  std::optional<ExitCode> refused_;
};

tl::expected<std::vector<health::Note>, ExitCode> notes_of(const HealthOptions& options) {
  std::string path = options.notes;
  if (path.empty() && !options.out.empty()) {
    const fs::path beside = fs::path(options.out) / "notes.yaml";
    if (is_there(beside)) path = beside.string();
  }
  if (path.empty()) return std::vector<health::Note>{};
  const auto text = read_file(path, largest_file);
  if (!text) return tl::unexpected(fail(ExitCode::io, text.error()));
  document::Problems problems;
  auto notes = health::read_notes(path, *text, problems);
  if (!notes) return tl::unexpected(refuse(problems));
  return *std::move(notes);
}

struct JudgedRig {
  std::vector<Judged> fingers;
  std::vector<health::SharedChange> shared;
};

JudgedRig judged(const std::vector<health::ScoredRun>& runs, const std::vector<health::Note>& notes,
                 Baselines& baselines, const health::HealthOptions& options) {
  std::map<std::string, std::vector<health::ScoredRun>> by_finger;
  for (const health::ScoredRun& run : runs) by_finger[run.finger].push_back(run);
  std::vector<health::FingerRuns> fingers;
  fingers.reserve(by_finger.size());
  for (auto& [finger, own] : by_finger)
    fingers.push_back({finger, std::move(own), baselines.of(finger)->base});
  health::RigHealth rig = health::judge_rig(std::move(fingers), notes, options);
  JudgedRig all{{}, std::move(rig.shared)};
  for (health::FingerHealth& health : rig.fingers) {
    const health::HealthSource source{baselines.folder_of(health.finger), baselines.of(health.finger)->base,
                                      options, all.shared};
    health::Suspicion suspicion = health::suspicion_of(health, all.shared);
    all.fingers.push_back({std::move(health), std::move(suspicion), source});
  }
  return all;
}

/// Numbers that the fingers share a change of.
std::vector<sysid::HealthNumber> numbers_of(const JudgedRig& rig) {
  std::vector<const health::FingerHealth*> all;
  for (const Judged& finger : rig.fingers) all.push_back(&finger.health);
  std::vector<sysid::HealthNumber> numbers = health::shared_changes(all);
  for (const health::SharedChange& shared : rig.shared) {
    if (shared.stands && std::find(numbers.begin(), numbers.end(), shared.number) == numbers.end())
      numbers.push_back(shared.number);
  }
  return numbers;
}

/// What is no alarm of a finger and should be known.
std::vector<std::string> warnings_of(const JudgedRig& rig) {
  std::vector<std::string> warnings;
  for (const health::SharedChange& shared : rig.shared) {
    if (shared.stands) warnings.push_back(health::shared_sentence(shared));
  }
  for (const Judged& finger : rig.fingers) {
    for (const health::HealthAlarm& unclear : finger.health.unclear)
      warnings.push_back(health::unclear_sentence(finger.health, unclear));
  }
  return warnings;
}

Json result_of(const HealthOptions& options, const JudgedRig& rig, const health::RunScores& scores) {
  const Nanoseconds now = wall_time_now();
  const health::ChartLimits limits = options.judge.limits();
  const bool alarm = std::any_of(rig.fingers.begin(), rig.fingers.end(), [](const Judged& finger) {
    return finger.health.state == health::FingerState::alarm;
  });
  Json json{
      {"schema", 1},
      {"made", utc_text(now)},
      {"made_unix_s", now / 1'000'000'000},
      {"software_version", std::string(software_version())},
      {"baseline", options.baseline},
      {"state", alarm ? "alarm" : "steady"},
      {"false_alarm_points", options.judge.false_alarm_points},
      {"limits", {{"allowance", limits.allowance}, {"cusum", limits.cusum}, {"single", limits.single}}}};
  json["fingers"] = Json::array();
  for (const Judged& finger : rig.fingers)
    json["fingers"].push_back(health::json_of(finger.health, finger.suspicion));
  json["shared"] = Json::array();
  for (const sysid::HealthNumber number : numbers_of(rig))
    json["shared"].push_back(sysid::info_of(number).id);
  json["shared_changes"] = Json::array();
  for (const health::SharedChange& shared : rig.shared)
    json["shared_changes"].push_back(health::json_of(shared));
  json["warnings"] = warnings_of(rig);
  json["skipped"] = Json::array();
  for (const health::SkippedRun& skipped : scores.skipped)
    json["skipped"].push_back({{"run", skipped.run}, {"why", skipped.why}});
  return json;
}

void print(const Judged& finger) {
  const health::FingerHealth& health = finger.health;
  std::printf("%s: %s\n", health.finger.c_str(), health_sentence(health, finger.suspicion).c_str());
  for (const health::HealthAlarm& alarm : health.standing()) {
    std::printf("  noticed %s, %zu grips after it began: %s\n", health.points[alarm.noticed].label.c_str(),
                alarm.grips, std::string(sysid::info_of(alarm.number).id).c_str());
  }
  for (const health::Suspect& suspect : finger.suspicion.suspects) {
    std::printf("  %s\n", suspect.id.c_str());
    for (const std::string& step : suspect.next_steps) std::printf("      - %s\n", step.c_str());
  }
  for (const std::string& advice : finger.suspicion.advice) std::printf("  - %s\n", advice.c_str());
  if (!finger.suspicion.suspects.empty())
    std::printf("  it settles it to record the commissioning experiment again:\n      %s\n",
                health::settling_command(finger.source.baseline).c_str());
}

tl::expected<void, std::string> write_results(const std::string& out, const Json& json,
                                              const std::vector<Judged>& fingers, const std::string& scores) {
  const auto write = [&](const std::string& name, const std::string& text) {
    return write_file((fs::path(out) / name).string(), text);
  };
  if (auto written = write(health::scores_file, scores); !written) return written;
  for (const Judged& finger : fingers) {
    const std::string page =
        finger.health.finger.empty() ? "health.html" : "health-" + finger.health.finger + ".html";
    if (auto written = write(page, health_page(finger.health, finger.suspicion, finger.source).to_html());
        !written)
      return written;
  }
  return write(health::health_file, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

ExitCode run(HealthOptions options) {
  std::vector<std::string> inputs = options.runs;
  inputs.insert(inputs.end(), {options.notes, options.baseline + "/baseline.json"});
  if (const auto code = refuse_overwriting(
          files_in(options.out, {health::scores_file, health::health_file, "health*.html"}), inputs))
    return *code;
  options.judge.by_day = options.points == "day";
  const auto notes = notes_of(options);
  if (!notes) return notes.error();
  Baselines baselines(options.baseline);
  const health::BaseOf base_of = [&](const std::string& finger) { return baselines.of(finger); };
  std::string kept;
  if (!options.out.empty()) {
    if (const auto ready = prepare_folder(options.out); !ready) return fail(ExitCode::io, ready.error());
    const std::string path = (fs::path(options.out) / health::scores_file).string();
    // A file that exists and cannot be read holds the scores of earlier days: it must not be replaced.
    auto earlier = is_there(path) ? read_file(path, largest_file) : std::string();
    if (!earlier) return fail(ExitCode::io, earlier.error());
    kept = std::move(*earlier);
    if (!kept.empty() && kept.back() != '\n') kept += '\n';
  }
  std::vector<health::ScoredRun> runs = health::read_scores(kept);
  const health::RunScores scores = health::score_runs(health::find_runs(options.runs), base_of, runs);
  if (baselines.refused()) return *baselines.refused();
  for (const health::ScoredRun& scored : scores.runs) {
    kept += health::line_of(scored);
    runs.push_back(scored);
  }
  const JudgedRig rig = judged(health::current(runs, base_of), *notes, baselines, options.judge);
  for (const health::SkippedRun& skipped : scores.skipped)
    std::fprintf(stderr, "softgrip: %s is left out: %s\n", skipped.run.c_str(), skipped.why.c_str());
  if (rig.fingers.empty())
    return fail(ExitCode::input_refused,
                "there is no recording that could be compared with " + options.baseline);
  const Json json = result_of(options, rig, scores);
  if (!options.out.empty()) {
    if (const auto written = write_results(options.out, json, rig.fingers, kept); !written)
      return fail(ExitCode::io, written.error());
  }
  if (options.json) {
    std::printf("%s\n", json.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
  } else {
    for (const Judged& finger : rig.fingers) print(finger);
    for (const std::string& warning : warnings_of(rig)) std::printf("%s\n", warning.c_str());
  }
  return json["state"] == "alarm" ? ExitCode::not_acceptable : ExitCode::done;
}

}  // namespace

void add_health(CLI::App& program, ExitCode& outcome) {
  auto options = std::make_shared<HealthOptions>();
  CLI::App* command = program.add_subcommand(
      "health", "What the recordings of a working day say of the fingers: what has changed, since when");
  command->add_option("runs", options->runs, "Recordings, or folders of recordings")->required();
  command
      ->add_option("--baseline", options->baseline,
                   "Folder of `softgrip baseline`; with a folder per finger in it, each has its own")
      ->required();
  command->add_option("--notes", options->notes, "What was mended, and when [notes.yaml beside the results]");
  command->add_option("--out", options->out,
                      "Folder for health.json, a page per finger, and the numbers of all recordings so far");
  command->add_option("--points", options->points, "What is judged as one: a day's grips, or each by itself")
      ->check(CLI::IsMember({"day", "run"}))
      ->capture_default_str();
  command
      ->add_option("--false-alarm-points", options->judge.false_alarm_points,
                   "A healthy finger alarms once in so many points, on the mean")
      ->check(CLI::Range(20.0, 1e9))
      ->capture_default_str();
  command->add_flag("--json", options->json, "Print health.json");
  command->footer(
      "Exit codes: 0 nothing has changed, 6 an alarm stands, 3 notes, baseline or recordings are refused,\n"
      "4 a file cannot be read or written.");
  command->callback([options, &outcome] { outcome = run(*options); });
}

}  // namespace softgrip::tools
