#pragma once
// Which recordings are meant, and their numbers.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sysid/health/scored_run.h"

namespace softgrip::sysid::health {

/// A folder with a run.csv, or a log, stands for itself; any other folder for the recordings in it, by name.
[[nodiscard]] std::vector<std::string> find_runs(const std::vector<std::string>& paths);

/// The baseline of a finger, and its id in the scores.
struct FingerBase {
  ScoreBase base;
  std::string id;
};
/// Null: the finger has no baseline.
using BaseOf = std::function<const FingerBase*(const std::string& finger)>;

struct SkippedRun {
  std::string run, why;
};

/// Called before each recording that is read: its index from 1, and their number.
using OnRecording = std::function<void(std::size_t index, std::size_t count)>;

struct RunScores {
  std::vector<ScoredRun> runs;  ///< one per run and finger
  std::vector<SkippedRun> skipped;
};

/// Scores the recordings that `known` does not have by today's baselines. One that cannot be used, or is not
/// finished, is skipped and named; the others count. A cancelled computation ends with the next recording.
/// @param on_recording  may be empty
[[nodiscard]] RunScores score_runs(const std::vector<std::string>& paths, const BaseOf& base_of,
                                   const std::vector<ScoredRun>& known, const OnRecording& on_recording = {});

/// Of each run and finger the last line that was scored by today's baseline.
[[nodiscard]] std::vector<ScoredRun> current(const std::vector<ScoredRun>& runs, const BaseOf& base_of);

}  // namespace softgrip::sysid::health
