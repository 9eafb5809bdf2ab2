#pragma once
// Finds the recordings that the arguments select and computes their indicators.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sysid/health/scored_run.h"

namespace softgrip::sysid::health {

/// Returns the recordings that the paths select. A folder with a run.csv is a recording, and so is a file.
/// Any other folder selects the recordings in it, sorted by name.
[[nodiscard]] std::vector<std::string> find_runs(const std::vector<std::string>& paths);

/// The baseline of a finger, and its id in the scores.
struct FingerBase {
  ScoreBase base;
  std::string id;
};
/// Returns the baseline of a finger; null if the finger has no baseline.
using BaseOf = std::function<const FingerBase*(const std::string& finger)>;

struct SkippedRun {
  std::string run, why;
};

/// Called before each recording is read, with its index (from 1) and the number of recordings to read.
using OnRecording = std::function<void(std::size_t index, std::size_t count)>;

struct RunScores {
  std::vector<ScoredRun> runs;  ///< one per run and finger
  std::vector<SkippedRun> skipped;
};

/// Scores the recordings that have no scores by the current baselines in `known`. A recording that cannot be
/// used or is not finished is added to `skipped`. A cancelled computation ends before the next recording.
/// @param on_recording  may be empty
[[nodiscard]] RunScores score_runs(const std::vector<std::string>& paths, const BaseOf& base_of,
                                   const std::vector<ScoredRun>& known, const OnRecording& on_recording = {});

/// Returns for each run and finger the last score that was computed with the current baseline.
[[nodiscard]] std::vector<ScoredRun> current(const std::vector<ScoredRun>& runs, const BaseOf& base_of);

}  // namespace softgrip::sysid::health
