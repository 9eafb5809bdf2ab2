#pragma once
// Finds the recordings that the paths select, and computes their indicators.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sysid/health/scored_run.h"

namespace softgrip::sysid::health {

/// Returns the recordings that the paths select. A path to a file or to a folder with a run.csv is a
/// recording. A path to any other folder selects all recordings in this folder, sorted by name.
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
/// `skipped`. If the computation is cancelled, it ends before the next recording.
/// @param on_recording  may be empty
[[nodiscard]] RunScores score_runs(const std::vector<std::string>& paths, const BaseOf& base_of,
                                   const std::vector<ScoredRun>& known, const OnRecording& on_recording = {});

/// Returns for each run and finger the last score that was computed with the current baseline.
[[nodiscard]] std::vector<ScoredRun> current(const std::vector<ScoredRun>& runs, const BaseOf& base_of);

}  // namespace softgrip::sysid::health
