#pragma once
// Plays the commissioning experiments of a healthy finger on its rig, each experiment twice.

#include <functional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "base/exit_code.h"
#include "sysid/diagnosis/experiments/waveform.h"
#include "sysid/logs/log.h"
#include "tools/investigation/experiment_rig.h"

namespace softgrip::tools {

/// Returns the names of the default experiments (see sysid::experiment_menu()). They contain several pressure
/// levels, pressure rates from the lowest to 100 times the lowest, holds and small hysteresis loops.
[[nodiscard]] const std::vector<std::string>& usual_commissioning();

struct CommissioningOptions {
  std::vector<std::string> experiments;  ///< names of the experiments to play, each at most once
  /// Rest at zero pressure before each experiment [s], because creep needs about a minute to decay. A
  /// simulated rig needs no rest, because each experiment starts from its initial state.
  double rest_s = 60;
  Consent consent;  ///< function that requests the user's consent; called once before the first motion, never
                    ///< called for a simulated rig
  std::function<void(const std::string&)> tell;  ///< function that prints one line before each motion; may be
                                                 ///< empty
};

struct CommissioningRuns {
  std::vector<sysid::Log> first;   ///< logs of the first run of the selected channel, one per experiment
  std::vector<sysid::Log> second;  ///< logs of the second run of the selected channel, one per experiment
  sysid::RigLimits limits;         ///< limits of pressure and pressure rate during the experiments
  double minutes = 0;  ///< time on the rig [min]: the sum of the planned durations of motions and rests
};

/// The reason why the experiments were not completed. The rig is vented, and no files remain.
struct NotCommissioned {
  ExitCode code = ExitCode::failed;
  std::string why;  ///< reason why the experiments were not completed, as a sentence
};

/// Plays the commissioning experiments twice. First, a gentle motion checks that the finger moves, and its
/// displacement is compared with the prediction of the rig file's model. The pressure of the gentle motion is
/// so large that the model predicts a motion well above the noise of the sensor. The largest pressure of the
/// experiments is the smaller of two values: the channel's limit, and the pressure at which the finger is
/// expected to use 90 % of the distance from rest to displacement_max_mm. Before the first run, the finger is
/// loaded twice to this pressure, so that both runs begin in equal conditions.
///
/// Every log is checked against the rig file's model of the channel. Returns ExitCode::not_acceptable if the
/// model predicts no clear motion, if the finger hardly moves or touches an object, if the rig does not play
/// the requested experiment, or if it has a fault. Returns ExitCode::failed if consent is refused or the user
/// presses Ctrl-C. Signals are held back during the runs.
[[nodiscard]] tl::expected<CommissioningRuns, NotCommissioned> play_commissioning(
    const ExperimentRig& rig, const CommissioningOptions& options);

}  // namespace softgrip::tools
