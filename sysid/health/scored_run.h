#pragma once
// Stores the indicators of each finger in each recorded run as one line of a file. Existing lines are not
// changed. The indicators therefore remain available after a recording has been deleted, and each recording
// is read once.

#include <cstddef>
#include <limits>
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

}  // namespace softgrip::sysid::health
