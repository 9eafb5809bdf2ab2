#include "sysid/health/recorded_health.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include "base/files.h"
#include "base/sha256.h"
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

tl::expected<RecordedHealth, std::vector<RefusedBaseline>> recorded_health(const HealthQuestion& question) {
  Baselines baselines(question.baseline);
  const BaseOf base_of = [&](const std::string& finger) { return baselines.of(finger); };
  RecordedHealth all{question.baseline, question.options, {}, {}, {}, question.scores};
  if (!all.scores.empty() && all.scores.back() != '\n') all.scores += '\n';
  std::vector<ScoredRun> runs = read_scores(all.scores);
  OnRecording on_recording;
  if (question.progress)
    on_recording = [&](std::size_t index, std::size_t count) {
      question.progress("recording " + std::to_string(index) + " of " + std::to_string(count));
    };
  RunScores scores = score_runs(find_runs(question.recordings), base_of, runs, on_recording);
  if (!baselines.refused().empty()) return tl::unexpected(baselines.refused());
  for (const ScoredRun& scored : scores.runs) {
    all.scores += line_of(scored);
    runs.push_back(scored);
  }
  all.skipped = std::move(scores.skipped);
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
