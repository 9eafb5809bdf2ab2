#pragma once
// Stores the indicators of each finger in each recorded run as one line of a file. Existing lines are not
// changed. The indicators therefore remain available after a recording has been deleted, and each recording
// is read once. The indicators are computed from the recordings that the paths select.

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "sysid/health/grip_score.h"

namespace softgrip::sysid::health {

struct ScoredRun {
  std::string run;         ///< name of the folder of the recording
  std::string finger;      ///< name of the finger's channel
  std::string started_at;  ///< UTC; empty: the start time is not known
  std::string recipe;      ///< recipe of the run; only runs with equal recipes are compared
  std::string baseline;    ///< id of the baseline relative to which the run was scored; empty: the finger had
                           ///< no baseline, and no indicator was computed
  GripScore score;
  /// Median temperature of the run [degC]; NaN: not recorded.
  double temperature_c = std::numeric_limits<double>::quiet_NaN();
  /// First characters of the SHA-256 hash of the log; empty in the lines of earlier versions.
  std::string log_hash = {};
};

/// Largest size of a file that `softgrip health` reads [bytes].
inline constexpr std::size_t largest_health_file = std::size_t{512} << 20U;
/// Name of the file of the scores in the output folder.
inline constexpr const char* scores_file = "health-scores.jsonl";

/// Returns the text of the file of the scores, or "" if the file does not exist. If the file exists but
/// cannot be read, the error is a sentence. The caller must then keep the file, because it holds the scores
/// of earlier days.
[[nodiscard]] tl::expected<std::string, std::string> earlier_scores(const std::string& path);
/// Reads the lines of the file of the scores. A line that is incomplete, for example after a power failure,
/// is skipped.
[[nodiscard]] std::vector<ScoredRun> read_scores(std::string_view text);
/// Returns the scores of a run as one line of the file, with a line break at the end.
[[nodiscard]] std::string line_of(const ScoredRun& run);

/// Returns the recordings that the paths select. A path to a file or to a folder with a run.csv is a
/// recording. For a run.csv beside a run.json, the recording is their folder. A path to any other folder
/// selects all recordings in this folder, sorted by name.
[[nodiscard]] std::vector<std::string> find_runs(const std::vector<std::string>& paths);

/// The baseline of a finger, and the id by which the scores refer to the baseline.
struct FingerBase {
  ScoreBase base;
  std::string id;
};
/// Returns the baseline of a finger; null if the finger has no baseline.
using BaseOf = std::function<const FingerBase*(const std::string& finger)>;

/// A recording that was not used, or the readings of one finger that were not used.
struct SkippedRun {
  std::string run, why;
  std::string finger = {};  ///< finger whose readings were not used; empty: the whole recording
  bool unreadable = false;  ///< true: `run` is a given path that does not exist or cannot be read
};

/// Callback before each recording is read.
/// @param index  index of this recording, from 1.
/// @param count  number of recordings to read.
using OnRecording = std::function<void(std::size_t index, std::size_t count)>;

struct RunScores {
  /// One element for each finger of each run. Without a baseline of the finger, `baseline` and all indicators
  /// are empty.
  std::vector<ScoredRun> runs;
  std::vector<SkippedRun> skipped;
};

/// Scores each recording for which `known` contains no scores with the current baselines. A recording is read
/// again if a finger without a baseline now has a baseline. An unusable or unfinished recording is added to
/// `skipped`, and also a recording with the name of an earlier recording that started at another time. If a
/// start time is not known, a recording whose log differs from the log of the earlier recording is added to
/// `skipped`. If the computation is cancelled, it ends before the next recording.
/// @param on_recording  may be empty
[[nodiscard]] RunScores score_runs(const std::vector<std::string>& paths, const BaseOf& base_of,
                                   const std::vector<ScoredRun>& known, const OnRecording& on_recording = {});

/// Returns for each run and finger the last score that was computed with the current baseline.
[[nodiscard]] std::vector<ScoredRun> current(const std::vector<ScoredRun>& runs, const BaseOf& base_of);

}  // namespace softgrip::sysid::health
