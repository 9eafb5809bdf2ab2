#pragma once
// Stores the indicators of each finger in each recorded run as one line of a file. Lines are only added. The
// indicators therefore remain available after a recording has been deleted, and no recording is read twice.

#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "sysid/health/grip_score.h"

namespace softgrip::sysid::health {

struct ScoredRun {
  std::string run;         ///< name of the recording's folder
  std::string finger;      ///< name of the channel
  std::string started_at;  ///< UTC; empty: not known
  std::string recipe;      ///< only runs of the same recipe are compared
  std::string baseline;    ///< id of the baseline that the scores refer to
  GripScore score;
  double temperature_c = std::numeric_limits<double>::quiet_NaN();  ///< median of the run; NaN: not recorded
};

/// Largest file that health reads [bytes].
inline constexpr std::size_t largest_health_file = std::size_t{512} << 20U;
/// File name in the output folder.
inline constexpr const char* scores_file = "health-scores.jsonl";

/// Returns the text of this file, or "" if there is none. The error is a sentence: an existing file that
/// cannot be read holds the scores of earlier days, so it must not be replaced.
[[nodiscard]] tl::expected<std::string, std::string> earlier_scores(const std::string& path);
/// Reads the lines of this file. An incomplete line, for example after a power failure, is skipped.
[[nodiscard]] std::vector<ScoredRun> read_scores(std::string_view text);
/// Returns the line of a run, with its line break.
[[nodiscard]] std::string line_of(const ScoredRun& run);

}  // namespace softgrip::sysid::health
