#include "sysid/health/recorded_health.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "base/files.h"
#include "base/sha256.h"
#include "base/text.h"
#include "model/file/model_file.h"
#include "sysid/changes/baseline_folder.h"
#include "sysid/logs/command_before.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid::health {
namespace {

namespace fs = std::filesystem;

/// Version of the score computation. This version is a prefix of the id of the baseline, so scores of earlier
/// versions are not used.
constexpr const char* scoring = "1-";
constexpr std::size_t id_letters = 12;

/// Reads the baseline of each finger once: from DIR/FINGER if that folder is a baseline, otherwise from DIR.
class Baselines {
 public:
  explicit Baselines(std::string folder) : folder_(std::move(folder)) {}

  /// Returns the baseline of a finger, or null if the finger has none. The pointer is valid as long as this
  /// object.
  const FingerBase* of(const std::string& finger) {
    const auto [base, is_new] = bases_.try_emplace(finger);
    if (is_new) base->second = read(folder_of(finger));
    return base->second ? &*base->second : nullptr;
  }
  [[nodiscard]] std::string folder_of(const std::string& finger) const {
    const fs::path own = fs::path(folder_) / finger;
    return !finger.empty() && is_there(own / "baseline.json") ? own.string() : folder_;
  }
  /// Returns the names of the fingers that have their own baseline: the folders in DIR that contain
  /// baseline.json.
  [[nodiscard]] std::set<std::string> own() const {
    std::set<std::string> fingers;
    std::error_code unreadable;
    for (const auto& entry : fs::directory_iterator(folder_, unreadable)) {
      if (is_there(entry.path() / "baseline.json")) fingers.insert(entry.path().filename().string());
    }
    return fingers;
  }
  /// Returns the reason why DIR contains no baseline of any finger.
  [[nodiscard]] std::optional<RefusedBaseline> missing() const {
    if (!is_there(folder_)) return RefusedBaseline{folder_ + " does not exist", {}, true};
    if (is_there(fs::path(folder_) / "baseline.json") || !own().empty()) return std::nullopt;
    return RefusedBaseline{folder_ +
                               " is not a baseline: neither this folder nor a folder in it contains "
                               "baseline.json, which `softgrip baseline` writes",
                           {}};
  }
  /// Returns the baselines that exist but are refused.
  [[nodiscard]] const std::vector<RefusedBaseline>& refused() const { return refused_; }

 private:
  std::optional<FingerBase> read(const std::string& folder) {
    const std::string file = (fs::path(folder) / "baseline.json").string();
    const auto bytes = read_file(file, largest_health_file);
    if (!bytes) return std::nullopt;
    const auto baseline = read_baseline(folder);
    if (!baseline) return refuse({baseline.error(), {}});
    document::Problems problems;
    const auto model = model::load_model(baseline->model, problems);
    if (!model) return refuse({{}, problems});
    LogOptions options;
    options.output_unit = model->output_unit;
    options.output_unit_of = "the model " + model->name;
    Campaign campaign = read_campaign(baseline->logs, problems, options);
    if (!problems.empty()) return refuse({{}, problems, campaign.unreadable});
    begin_before_first_command(campaign.logs, false);
    const double full_kpa = largest_command_kpa(campaign.logs);
    if (!(full_kpa > 0))
      return refuse({folder + ": the logs of this baseline contain no pressure above 0", {}});
    return FingerBase{score_base(*model, full_kpa), scoring + sha256(*bytes).substr(0, id_letters)};
  }
  std::nullopt_t refuse(RefusedBaseline refused) {
    refused_.push_back(std::move(refused));
    return std::nullopt;
  }

  std::string folder_;
  std::map<std::string, std::optional<FingerBase>> bases_;
  std::vector<RefusedBaseline> refused_;
};

/// Returns one element for each finger without a baseline, with the last recording of the finger in
/// alphabetical order.
std::vector<SkippedRun> without_baseline(const std::vector<ScoredRun>& runs, Baselines& baselines) {
  std::map<std::string, std::set<std::string>> recordings;
  for (const ScoredRun& run : runs) {
    if (baselines.of(run.finger) == nullptr) recordings[run.finger].insert(run.run);
  }
  std::vector<SkippedRun> skipped;
  for (const auto& [finger, names] : recordings) {
    const std::string count =
        std::to_string(names.size()) + (names.size() == 1 ? " recording" : " recordings");
    skipped.push_back({*names.rbegin(),
                       "there is no baseline of " +
                           (finger.empty() ? "a finger without a name" : document::in_backticks(finger)) +
                           ", so its readings in " + count + " are not used",
                       finger});
  }
  return skipped;
}

/// Returns find_runs(paths), and adds each folder without recordings and each unreadable path to `skipped`.
std::vector<std::string> runs_in(const std::vector<std::string>& paths, std::vector<SkippedRun>& skipped) {
  std::vector<std::string> runs;
  for (const std::string& path : paths) {
    // A folder with a run.csv is a recording, whose log is read later.
    if (const std::string why = why_unreadable(path); !why.empty() && !is_there(path + "/run.csv")) {
      skipped.push_back({path, "the path cannot be read: " + why, {}, true});
      continue;
    }
    const std::vector<std::string> found = find_runs({path});
    if (found.empty()) skipped.push_back({path, "the folder contains no recordings"});
    runs.insert(runs.end(), found.begin(), found.end());
  }
  return runs;
}

/// Returns the problems of notes that name an unknown finger. Such a note would close no alarm.
document::Problems unknown_fingers(const HealthQuestion& question, const std::vector<ScoredRun>& runs,
                                   const Baselines& baselines) {
  std::set<std::string> known = baselines.own();
  for (const ScoredRun& run : runs) known.insert(run.finger);
  if (const auto baseline = read_baseline(question.baseline)) known.insert(baseline->channel);
  known.erase("");  // recordings and baselines without a channel
  const std::vector<std::string> names(known.begin(), known.end());
  document::Problems problems;
  for (const Note& note : question.notes) {
    if (note.finger.empty() || known.contains(note.finger)) continue;
    document::Problem problem = note.finger_at;
    problem.message = "no recording and no baseline has a finger " + document::in_backticks(note.finger);
    const std::string near = document::nearest(note.finger, names);
    problem.hint = near.empty() ? "known fingers: " + with_commas(names)
                                : "did you mean " + document::in_backticks(near) + "?";
    problems.add(std::move(problem));
  }
  return problems;
}

void judge(const std::vector<ScoredRun>& runs, const HealthQuestion& question, Baselines& baselines,
           RecordedHealth& all) {
  std::map<std::string, std::vector<ScoredRun>> by_finger;
  for (const ScoredRun& run : runs) by_finger[run.finger].push_back(run);
  std::vector<FingerRuns> fingers;
  fingers.reserve(by_finger.size());
  for (auto& [finger, own] : by_finger)
    fingers.push_back({finger, std::move(own), baselines.of(finger)->base});
  RigHealth rig = judge_rig(std::move(fingers), question.notes, question.options);
  all.shared = std::move(rig.shared);
  for (FingerHealth& health : rig.fingers) {
    const HealthSource source{baselines.folder_of(health.finger), baselines.of(health.finger)->base,
                              question.options, all.shared};
    Suspicion suspicion = suspicion_of(health, all.shared);
    all.fingers.push_back({std::move(health), std::move(suspicion), source});
  }
}

}  // namespace

bool RecordedHealth::alarm() const {
  return std::any_of(fingers.begin(), fingers.end(),
                     [](const JudgedFinger& finger) { return finger.health.state == FingerState::alarm; });
}

bool RecordedHealth::incomplete() const {
  return std::any_of(skipped.begin(), skipped.end(), [](const SkippedRun& run) { return run.unreadable; });
}

tl::expected<RecordedHealth, HealthRefusal> recorded_health(const HealthQuestion& question) {
  Baselines baselines(question.baseline);
  if (auto missing = baselines.missing()) return tl::unexpected(HealthRefusal{{std::move(*missing)}, {}});
  const BaseOf base_of = [&](const std::string& finger) { return baselines.of(finger); };
  RecordedHealth all{question.baseline, question.options, {}, {}, {}, question.scores};
  if (!all.scores.empty() && all.scores.back() != '\n') all.scores += '\n';
  std::vector<ScoredRun> runs = read_scores(all.scores);
  OnRecording on_recording;
  if (question.progress)
    on_recording = [&](std::size_t index, std::size_t count) {
      question.progress("recording " + std::to_string(index) + " of " + std::to_string(count));
    };
  RunScores scores = score_runs(runs_in(question.recordings, all.skipped), base_of, runs, on_recording);
  if (!baselines.refused().empty()) return tl::unexpected(HealthRefusal{baselines.refused(), {}});
  for (const ScoredRun& scored : scores.runs) {
    all.scores += line_of(scored);
    runs.push_back(scored);
  }
  if (!runs.empty()) {
    if (document::Problems unknown = unknown_fingers(question, runs, baselines); !unknown.empty())
      return tl::unexpected(HealthRefusal{{}, std::move(unknown)});
  }
  all.skipped.insert(all.skipped.end(), scores.skipped.begin(), scores.skipped.end());
  const std::vector<SkippedRun> incomplete = without_baseline(runs, baselines);
  all.skipped.insert(all.skipped.end(), incomplete.begin(), incomplete.end());
  judge(current(runs, base_of), question, baselines, all);
  return all;
}

std::vector<std::string> warnings_of(const RecordedHealth& health) {
  std::vector<std::string> warnings;
  for (const SharedChange& shared : health.shared) {
    if (shared.stands) warnings.push_back(shared_sentence(shared));
  }
  for (const JudgedFinger& finger : health.fingers) {
    for (const HealthAlarm& unclear : finger.health.unclear)
      warnings.push_back(unclear_sentence(finger.health, unclear));
  }
  return warnings;
}

}  // namespace softgrip::sysid::health
