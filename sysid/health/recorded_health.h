#pragma once
// Computes the result of `softgrip health`: scores recordings relative to the baselines of their fingers, and
// judges each finger by all its scores.

#include <functional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "document/problem.h"
#include "sysid/health/health_page.h"
#include "sysid/health/scored_run.h"

namespace softgrip::sysid::health {

struct HealthQuestion {
  std::vector<std::string> recordings;  ///< paths of recordings, or of folders that contain recordings
  /// Folder that `softgrip baseline` wrote. If it contains a folder FINGER with a baseline, that baseline is
  /// used for the finger.
  std::string baseline;
  std::vector<Note> notes;
  HealthOptions options;
  std::string scores;  ///< scores from an earlier call, as text; recordings with scores for the current
                       ///< baselines are not read again
  /// Called with a text that states the progress; may be empty.
  std::function<void(const std::string&)> progress = {};
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
  std::vector<JudgedFinger> fingers;  ///< sorted by name; empty: no recording can be compared with a baseline
  std::vector<SharedChange> shared;
  std::vector<SkippedRun> skipped;  ///< unusable recordings, and given paths that cannot be read
  std::string scores;  ///< text of the earlier scores, followed by the scores of the new recordings

  /// Returns true if an alarm of a finger is active.
  [[nodiscard]] bool alarm() const;
  /// Returns true if a given path of the recordings does not exist or cannot be read.
  [[nodiscard]] bool incomplete() const;
};

/// Folder of a baseline that cannot be used, and the reason.
struct RefusedBaseline {
  std::string why;              ///< reason as a sentence; empty: `problems` state the reason
  document::Problems problems;  ///< problems of the baseline's model or logs
  bool unreadable = false;      ///< true: a file of the baseline cannot be opened
};

/// Inputs that recorded_health() refuses. `baselines` or `notes` is not empty.
struct HealthRefusal {
  std::vector<RefusedBaseline> baselines;
  document::Problems notes;  ///< notes about a finger that is unknown
};

/// Scores the recordings whose scores are not in `question.scores`, and judges all fingers. A note is refused
/// if its finger occurs in no recording, no score and no baseline. `skipped` contains the unusable
/// recordings, and one element for each finger that has recordings but no baseline.
[[nodiscard]] tl::expected<RecordedHealth, HealthRefusal> recorded_health(const HealthQuestion& question);

/// Returns warnings about shared changes and about changes that are not attributed to a finger.
[[nodiscard]] std::vector<std::string> warnings_of(const RecordedHealth& health);

}  // namespace softgrip::sysid::health
