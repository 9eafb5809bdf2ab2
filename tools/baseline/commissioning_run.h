#pragma once
// The commissioning experiment: what a healthy finger is asked on its rig, twice.

#include <functional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "base/exit_code.h"
#include "sysid/diagnosis/experiments/waveform.h"
#include "sysid/logs/log.h"
#include "tools/investigation/experiment_rig.h"

namespace softgrip::tools {

/// Entries of the menu of experiments that are played where none are named: several heights, rates over two
/// decades, holds, small loops.
[[nodiscard]] const std::vector<std::string>& usual_commissioning();

struct CommissioningOptions {
  std::vector<std::string> experiments;  ///< names of the menu, each once
  /// At no pressure before each, so that it begins as on any morning: fingers creep back for a minute. Not
  /// for a simulated rig, which begins anew each time.
  double rest_s = 60;
  Consent consent;  ///< asked once, before anything moves; never for a simulated rig
  std::function<void(const std::string&)> tell;  ///< one line before each motion; may be empty
};

struct CommissioningRuns {
  std::vector<sysid::Log> first;   ///< one per experiment, of the one channel
  std::vector<sysid::Log> second;  ///< the same experiments again
  sysid::RigLimits limits;         ///< within which they were played
  double minutes = 0;              ///< of the rig's time, as the experiments say
};

/// Why there are no runs. The rig is vented; nothing is left behind.
struct NotCommissioned {
  ExitCode code = ExitCode::failed;
  std::string why;  ///< a sentence
};

/// A gentle pressure first, to see that the finger moves and how far the rest may go: within the channel's
/// limits, and no further than 90 % of the way to displacement_max_mm as the model says, scaled by what the
/// gentle pressure did. Then the finger is loaded twice to the largest pressure of all, so that both runs
/// find it in the same state. Every log is judged as it comes: a finger that hardly moves, that touches
/// something, a rig that plays something else or has a fault ends it with ExitCode::not_acceptable; a refusal
/// or Ctrl-C with ExitCode::failed. The model that the rig file has for the channel says what a free
/// way looks like. Signals are held back while it runs.
[[nodiscard]] tl::expected<CommissioningRuns, NotCommissioned> play_commissioning(
    const ExperimentRig& rig, const CommissioningOptions& options);

}  // namespace softgrip::tools
