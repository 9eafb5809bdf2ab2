#pragma once
// Computes the result of `softgrip health`: scores recordings relative to the baselines of their fingers, and
// judges all scores.

#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>
#include <tl/expected.hpp>

#include "base/time.h"
#include "document/problem.h"
#include "sysid/health/health_page.h"
#include "sysid/health/run_search.h"

namespace softgrip::sysid::health {

struct HealthQuestion {
  std::vector<std::string> recordings;  ///< recordings, or folders of recordings
  /// Folder that `softgrip baseline` wrote. If it contains a folder FINGER with a baseline, that baseline is
  /// used for the finger.
  std::string baseline;
  std::vector<Note> notes;
  HealthOptions options;
  std::string scores;  ///< text of earlier scores; their recordings are not read again
  std::function<void(const std::string&)> progress = {};  ///< called with the progress as text; may be empty
};

/// The result for one finger of the rig.
struct JudgedFinger {
  FingerHealth health;
  Suspicion suspicion;
  HealthSource source;
};

struct RecordedHealth {
  std::string baseline;
  HealthOptions options;
  std::vector<JudgedFinger> fingers;  ///< by name; empty: no recording can be compared with the baseline
  std::vector<SharedChange> shared;
  std::vector<SkippedRun> skipped;
  std::string scores;  ///< text of the earlier scores and of the scores of the new recordings

  /// Returns true if an alarm of a finger is active.
  [[nodiscard]] bool alarm() const;
};

/// Reason why a baseline is refused.
struct RefusedBaseline {
  std::string why;              ///< a sentence; empty: the problems state the reason
  document::Problems problems;  ///< problems of its model or its logs
  bool unreadable = false;      ///< a file cannot be opened
};

/// Scores the recordings that are not in `question.scores`, and judges all fingers. The error contains at
/// least one refused baseline.
[[nodiscard]] tl::expected<RecordedHealth, std::vector<RefusedBaseline>> recorded_health(
    const HealthQuestion& question);

/// Returns warnings about shared changes and about changes that are not attributed to a finger.
[[nodiscard]] std::vector<std::string> warnings_of(const RecordedHealth& health);

/// Returns the content of health.json. @param now  creation time that the file states.
[[nodiscard]] nlohmann::ordered_json json_of(const RecordedHealth& health, Nanoseconds now);
/// Returns the text of health.json, without a line break at the end.
[[nodiscard]] std::string health_json_text(const nlohmann::ordered_json& json);

}  // namespace softgrip::sysid::health
