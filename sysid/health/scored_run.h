#pragma once
// One finger's numbers of one recorded run, and where they are kept: a line each in a file that only grows,
// so that the numbers outlive the recordings and no recording is read twice.

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
  std::string recipe;      ///< only runs of the same one are compared
  std::string baseline;    ///< by what it was scored
  GripScore score;
  double temperature_c = std::numeric_limits<double>::quiet_NaN();  ///< its median; NaN: not recorded
};

/// The file's name in the folder for results.
inline constexpr const char* scores_file = "health-scores.jsonl";

/// Returns the lines of such a file. An incomplete line, for example after a power failure, is skipped.
[[nodiscard]] std::vector<ScoredRun> read_scores(std::string_view text);
/// One line, with its end.
[[nodiscard]] std::string line_of(const ScoredRun& run);

}  // namespace softgrip::sysid::health
