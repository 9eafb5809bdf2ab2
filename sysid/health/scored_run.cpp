#include "sysid/health/scored_run.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/files.h"
#include "base/json.h"
#include "base/sha256.h"
#include "base/statistics.h"
#include "base/thread_budget.h"
#include "sysid/logs/finite_values.h"
#include "sysid/recordings/recording.h"

namespace softgrip::sysid::health {
namespace {

using Json = nlohmann::ordered_json;

namespace fs = std::filesystem;

/// Returns true if `path` is a recording. A folder that cannot be read counts as a recording, so that its
/// reader reports the error.
bool is_run(const fs::path& path) {
  std::error_code ignored, unreadable;
  return !fs::is_directory(path, ignored) || fs::exists(path / "run.csv", unreadable) || unreadable;
}

/// Returns the folder of the recording if `path` is the run.csv of a recording, so that run.json is also
/// read. Otherwise returns `path`.
std::string recording_at(const std::string& path) {
  const fs::path csv = plain_path(path);
  if (csv.filename() != "run.csv" || is_folder(path)) return path;
  std::error_code error;
  const fs::path folder = csv.has_parent_path() ? csv.parent_path() : fs::current_path(error);
  return is_there(folder / "run.json") ? folder.string() : path;
}

/// Returns the first characters of a SHA-256 hash. They are stored with the scores.
std::string shortened(const std::string& hash) {
  constexpr std::size_t letters = 12;
  return hash.substr(0, letters);
}

/// Returns the shortened hash of a recording's log; empty if the log cannot be read.
std::string hash_of_log(const std::string& path) {
  const auto file = log_file_of(path);
  if (!file) return {};
  const auto text = read_file(*file, largest_health_file);
  return text ? shortened(sha256(*text)) : std::string();
}

/// Returns true if the recording at `path` is not the recording of an earlier score with the same name.
bool is_namesake(const std::string& path, const ScoredRun& earlier) {
  const std::string start = read_recording_data(path).started_at;
  if (!start.empty() && !earlier.started_at.empty()) return start != earlier.started_at;
  if (earlier.log_hash.empty()) return false;
  const std::string hash = hash_of_log(path);
  return !hash.empty() && hash != earlier.log_hash;
}

/// Returns the median temperature of a run. One value per run is enough, because the temperature of a finger
/// hardly changes during a grip.
double temperature_of(const sysid::Log& log) {
  std::vector<double> known = finite_values(log.temperature_c).values;
  return known.empty() ? std::numeric_limits<double>::quiet_NaN() : median_of(std::span<double>(known));
}

/// Returns the reason why a recording is not scored, or an empty text. The reason depends only on run.json.
std::string skip_reason(const Recording& recording) {
  if (recording.unfinished) return "the recording is not finished";
  // A recording of a fault or of a whole day belongs to no sequence, so there are no recordings with which it
  // can be compared.
  if (recording.recipe.empty() && !recording.software_version.empty())
    return "the recording does not belong to a single sequence (with `mode: sequences`, the recorder writes "
           "one recording per sequence)";
  // After a disk error, a recording can begin during a sequence.
  if (!recording.events.empty() &&
      std::ranges::find(recording.events, "sequence_started", &RecordedEvent::kind) == recording.events.end())
    return "the recording begins after the start of its sequence";
  return {};
}

void score_one(const std::string& path, const BaseOf& base_of, RunScores& scores) {
  document::Problems problems;
  const std::string name = name_in_path(path);
  // The log of a whole day can be large, so run.json is read first.
  if (const std::string reason = skip_reason(read_recording_data(path)); !reason.empty()) {
    scores.skipped.push_back({name, reason});
    return;
  }
  const auto recording = read_recording(path, problems);
  if (!recording) {
    scores.skipped.push_back({name, problems.empty() ? recording.error() : problems.list().front().message});
    return;
  }
  for (std::size_t c = 0; c < recording->channels.size(); ++c) {
    const std::string& finger = recording->channels[c].channel;
    ScoredRun run{recording->name, finger, recording->started_at, recording->recipe, {}, {}};
    run.log_hash = shortened(recording->channels[c].sha256);
    if (const FingerBase* const base = base_of(finger); base != nullptr) {
      const model::OutputUnit unit = recording->channels[c].output_unit;
      if (unit != base->base.model.output_unit) {
        scores.skipped.push_back({name, "the readings of the recording are in " + std::string(name_of(unit)) +
                                            ", but the baseline of `" + finger + "` is in " +
                                            std::string(name_of(base->base.model.output_unit))});
        continue;
      }
      run.baseline = base->id;
      run.score = score_of(*recording, c, base->base);
      run.temperature_c = temperature_of(recording->channels[c]);
    }
    scores.runs.push_back(std::move(run));
  }
}

}  // namespace

tl::expected<std::string, std::string> earlier_scores(const std::string& path) {
  if (!is_there(path)) return std::string();
  return read_file(path, largest_health_file);
}

std::vector<ScoredRun> read_scores(std::string_view text) {
  std::vector<ScoredRun> runs;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const Json line = Json::parse(text.substr(begin, end - begin), nullptr, false);
    begin = end + 1;
    if (!line.is_object()) continue;
    ScoredRun run{json_text(line, "run"),    json_text(line, "finger"),   json_text(line, "started_at"),
                  json_text(line, "recipe"), json_text(line, "baseline"), {}};
    for (std::size_t i = 0; i < sysid::health_numbers; ++i) {
      const Json& value = json_member(line, sysid::health_number_infos[i].id);
      if (value.is_number()) run.score.values[i] = value.get<double>();
    }
    const Json& temperature = json_member(line, "temperature_c");
    if (temperature.is_number()) run.temperature_c = temperature.get<double>();
    run.log_hash = json_text(line, "log_hash");
    runs.push_back(std::move(run));
  }
  return runs;
}

std::string line_of(const ScoredRun& run) {
  Json line{{"run", run.run},
            {"finger", run.finger},
            {"started_at", run.started_at},
            {"recipe", run.recipe},
            {"baseline", run.baseline}};
  for (std::size_t i = 0; i < sysid::health_numbers; ++i) {
    const double value = run.score.values[i];
    line[std::string(sysid::health_number_infos[i].id)] = std::isfinite(value) ? Json(value) : Json(nullptr);
  }
  if (std::isfinite(run.temperature_c)) line["temperature_c"] = run.temperature_c;
  if (!run.log_hash.empty()) line["log_hash"] = run.log_hash;
  return json_dump(line) + "\n";
}

std::vector<std::string> find_runs(const std::vector<std::string>& paths) {
  std::vector<std::string> runs;
  for (const std::string& path : paths) {
    if (is_run(path)) {
      runs.push_back(recording_at(path));
      continue;
    }
    std::vector<std::string> inside;
    std::error_code unreadable;
    for (const auto& entry : fs::directory_iterator(path, unreadable)) {
      if (entry.is_directory() && is_run(entry.path())) inside.push_back(entry.path().string());
    }
    std::sort(inside.begin(), inside.end());
    runs.insert(runs.end(), inside.begin(), inside.end());
  }
  return runs;
}

std::vector<ScoredRun> current(const std::vector<ScoredRun>& runs, const BaseOf& base_of) {
  std::map<std::pair<std::string, std::string>, std::size_t> place;
  std::vector<ScoredRun> kept;
  for (const ScoredRun& run : runs) {
    const FingerBase* const base = base_of(run.finger);
    if (base == nullptr || base->id != run.baseline) continue;
    const auto [at, is_new] = place.try_emplace({run.run, run.finger}, kept.size());
    if (is_new)
      kept.push_back(run);
    else
      kept[at->second] = run;
  }
  return kept;
}

RunScores score_runs(const std::vector<std::string>& paths, const BaseOf& base_of,
                     const std::vector<ScoredRun>& known, const OnRecording& on_recording) {
  std::set<std::pair<std::string, std::string>> stale;
  std::set<std::string> done;
  for (const ScoredRun& run : known) {
    if (base_of(run.finger) == nullptr)
      done.insert(run.run);
    else
      stale.emplace(run.run, run.finger);
  }
  for (const ScoredRun& run : current(known, base_of)) {
    stale.erase({run.run, run.finger});
    done.insert(run.run);
  }
  for (const auto& [run, finger] : stale) done.erase(run);
  std::map<std::string, const ScoredRun*> earlier;
  for (const ScoredRun& run : known) earlier[run.run] = &run;
  RunScores scores;
  const auto skip_namesake = [&](const std::string& path) {
    scores.skipped.push_back({name_in_path(path), "another recording has the same name: rename " + path});
  };
  std::vector<std::string> unread;
  for (const std::string& path : paths) {
    const auto same_name = earlier.find(name_in_path(path));
    if (same_name != earlier.end() && is_namesake(path, *same_name->second))
      skip_namesake(path);
    else if (!done.contains(name_in_path(path)))
      unread.push_back(path);
  }
  std::map<std::string, std::string> path_of;
  for (std::size_t i = 0; i < unread.size(); ++i) {
    end_if_cancelled();
    if (on_recording) on_recording(i + 1, unread.size());
    const std::string path = plain_path(unread[i]);
    const auto [first, is_new] = path_of.try_emplace(name_in_path(unread[i]), path);
    if (is_new)
      score_one(unread[i], base_of, scores);
    else if (first->second != path)
      skip_namesake(unread[i]);
  }
  return scores;
}

}  // namespace softgrip::sysid::health
