#pragma once
// Plays the experiments of an investigation on a rig. The rig is either described by a rig file and
// controlled by the daemon's code, or it is a command that the user provides. Checks that the rig played the
// requested experiment.
// Measures the closed loop on a rig. The rig tracks the same sine twice, once with each of two controllers.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include <tl/expected.hpp>

#include "base/result/result.h"
#include "daemon/service/daemon.h"
#include "document/problem.h"
#include "model/model.h"
#include "rig/rig_file.h"
#include "sysid/diagnosis/experiments/waveform.h"
#include "sysid/identification/validate.h"
#include "sysid/logs/log.h"
#include "tools/investigation/closed_loop_gain.h"
#include "tools/investigation/investigation.h"

namespace softgrip::tools {

/// A rig from a rig file, with the channel on which experiments are played.
struct ExperimentRig {
  rig::RigFile rig;
  std::size_t channel = 0;
  bool simulated = false;  ///< true: the rig is simulated in this process, so no hardware moves, and time is
                           ///< virtual
  /// Runs a sequence on the rig. A test may set a function that uses another clock and another board.
  daemon::DaemonRunner run = daemon::run_daemon;

  [[nodiscard]] const std::string& channel_name() const { return rig.settings.channels[channel].name; }
  /// Returns the rig for the run with the number `occasion`. A simulated rig has a different noise seed in
  /// each run.
  [[nodiscard]] ExperimentRig at(std::uint64_t occasion) const;
  /// Returns the limits of the rig, which determine the waveforms of the experiments.
  /// @param gain_mm_per_kpa  gain of the finger in the logs, which is used to limit the displacement; 0:
  /// unknown.
  /// @param known_kpa  largest pressure of the logs. Above this pressure, a smaller share of the displacement
  /// range may be used.
  [[nodiscard]] sysid::RigLimits limits(double gain_mm_per_kpa, double known_kpa) const;
};

/// Returns the index of the channel with this name in the rig file. An empty name selects the channel of a
/// rig with one channel. Returns nullopt if there is no such channel.
[[nodiscard]] std::optional<std::size_t> channel_of(const rig::RigFile& rig, const std::string& name);

/// Returns the rig with the channel of this name selected. An empty name selects the channel of a rig with
/// one channel. A channel is refused if its rest pressure is not 0 kPa, or if its largest pressure is not
/// above 0 kPa. The error is a sentence.
[[nodiscard]] tl::expected<ExperimentRig, std::string> experiment_rig(rig::RigFile rig,
                                                                      const std::string& channel);

/// Plays a sequence given as YAML text. Returns the path of its recording: `folder`/NAME.
[[nodiscard]] tl::expected<std::string, NotPlayed> run_on(const ExperimentRig& rig, const std::string& name,
                                                          const std::string& sequence_yaml,
                                                          const std::string& folder);

/// Plays a sequence given as YAML text. Returns the log of the rig's channel.
[[nodiscard]] tl::expected<sysid::Log, NotPlayed> played_on(const ExperimentRig& rig, const std::string& name,
                                                            const std::string& sequence_yaml,
                                                            const std::string& folder);

/// Function that is called before any motion with a sentence that describes the motion. If the function
/// returns true, the motion is allowed.
using Consent = std::function<bool(const std::string& what)>;

/// Returns a player that runs the experiments in the foreground, as `softgrip run` does. A signal vents the
/// rig and stops the investigation.
[[nodiscard]] Player rig_player(ExperimentRig rig, Consent consent);

/// Returns a player that runs `COMMAND COMMAND_CSV LOG_OUT`, where COMMAND is `command`. The file COMMAND_CSV
/// has the columns time_s and pressure_command_kpa, with one row per `interval_s`. The command must write a
/// log to LOG_OUT. An earlier file LOG_OUT is removed before the call.
[[nodiscard]] Player command_player(std::string command, double interval_s, Consent consent);

/// Returns a function that checks the sensor of a simulated rig. The function applies known lengths to the
/// sensor blocks of the simulated model, and adds the rig's noise and quantisation. Lengths outside the range
/// of the sensor are omitted.
[[nodiscard]] GaugeTaker simulated_gauge(ExperimentRig rig);

/// Returns a function that checks a sensor. The function runs `COMMAND POSITIONS_CSV GAUGE_OUT`, where
/// COMMAND is `command`, and reads the file GAUGE_OUT. An earlier file GAUGE_OUT is removed before the call.
[[nodiscard]] GaugeTaker command_gauge(std::string command, Consent consent);

/// Writes the readings to `folder`/gauge.csv, and reads this file in the same way as a gauge file of a user.
[[nodiscard]] tl::expected<sysid::GaugeFile, NotPlayed> gauge_file_of(
    const std::vector<sysid::GaugeReading>& readings, const std::string& folder);

/// Returns a sentence if the log is shorter than the waveform, or if its command differs from the waveform in
/// largest pressure or total travel; otherwise nullopt.
[[nodiscard]] std::optional<std::string> broken_promise(const sysid::Waveform& asked, const sysid::Log& log);

/// Returns a sentence if an object blocked the finger; otherwise nullopt. The check uses pressures up to
/// `known_kpa`. A blocked finger moves as predicted in the lower part of its stroke, and much less than
/// predicted in the upper part.
/// @param predicted  prediction for the log by a model without contact
/// @param known_kpa  largest pressure of the logs to which the model was fitted
[[nodiscard]] std::optional<std::string> touched(const sysid::Validation& predicted, const sysid::Log& log,
                                                 double known_kpa);

/// RMS difference between reading and reference over the measured cycles of a track step [mm], for each of
/// the two controllers.
struct RigTracking {
  double recalibrated_rmse_mm = 0;
  double extended_rmse_mm = 0;
  int cycles = 0;
};

/// Tracks the reference of `gain` on one channel of the rig twice: with the controller for the refitted model
/// and with the controller for the extended model. Recordings are written to `folder`.
[[nodiscard]] tl::expected<RigTracking, NotPlayed> track_on_rig(
    const ExperimentRig& rig, const model::Model& recalibrated, const model::Model& extended,
    const ClosedLoopGain& gain, const std::string& folder, const Consent& consent);

/// Returns the value of the key "closed_loop.on_rig" of investigation.json.
[[nodiscard]] result::Fields fields_of(const RigTracking& tracking);

}  // namespace softgrip::tools
