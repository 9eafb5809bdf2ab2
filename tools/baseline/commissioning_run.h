#pragma once
// The commissioning experiment of a healthy finger, played twice on its rig.

#include <functional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "base/exit_code.h"
#include "sysid/diagnosis/experiments/waveform.h"
#include "sysid/logs/log.h"
#include "tools/investigation/experiment_rig.h"

namespace softgrip::tools {

/// Returns the default experiments of the menu: several heights, rates over two decades, holds and small
/// loops.
[[nodiscard]] const std::vector<std::string>& usual_commissioning();

struct CommissioningOptions {
  std::vector<std::string> experiments;  ///< names of the menu, each at most once
  /// Rest at zero pressure before each experiment, because creep needs about a minute to decay. A simulated
  /// rig needs no rest, because it starts from its initial state each time.
  double rest_s = 60;
  Consent consent;                               ///< called once before any motion; never for a simulated rig
  std::function<void(const std::string&)> tell;  ///< reports one line before each motion; may be empty
};

struct CommissioningRuns {
  std::vector<sysid::Log> first;   ///< one log per experiment, of the selected channel
  std::vector<sysid::Log> second;  ///< logs of the repeated experiments
  sysid::RigLimits limits;         ///< limits of the experiments
  double minutes = 0;              ///< time on the rig, by the durations of the experiments
};

/// The reason why there are no runs. The rig is vented, and no files remain.
struct NotCommissioned {
  ExitCode code = ExitCode::failed;
  std::string why;  ///< a sentence
};

/// Plays the commissioning experiment twice. First, a gentle pressure shows that the finger moves. It also
/// limits the experiments: within the limits of the channel, and to 90 % of the way to displacement_max_mm as
/// predicted by the model and scaled by the measured motion. Then the finger is loaded twice to the largest
/// pressure, so that both runs begin in the same state.
///
/// Every log is checked against the rig file's model of the channel. ExitCode::not_acceptable: the finger
/// hardly moves or touches an object, or the rig plays something else or has a fault. ExitCode::failed: no
/// consent, or Ctrl-C. Signals are held back during the runs.
[[nodiscard]] tl::expected<CommissioningRuns, NotCommissioned> play_commissioning(
    const ExperimentRig& rig, const CommissioningOptions& options);

}  // namespace softgrip::tools
