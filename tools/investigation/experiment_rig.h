#pragma once
// The rigs on which an investigation plays its experiments. This is either the rig of a rig file, through the
// daemon's own code, or a command that the user provides.

#include <cstdint>
#include <functional>
#include <string>

#include <tl/expected.hpp>

#include "daemon/service/daemon.h"
#include "document/problem.h"
#include "rig/rig_file.h"
#include "sysid/diagnosis/experiments/waveform.h"
#include "tools/investigation/investigation.h"

namespace softgrip::tools {

/// One channel of the rig of a rig file.
struct ExperimentRig {
  rig::RigFile rig;
  std::size_t channel = 0;
  bool simulated = false;  ///< simulated in the process: nothing moves, and time is virtual
  /// Plays the sequences. A test may replace it with another clock and another board.
  daemon::DaemonRunner run = daemon::run_daemon;

  [[nodiscard]] const std::string& channel_name() const { return rig.settings.channels[channel].name; }
  /// Returns the rig for another run. If it is simulated, its noise has another seed.
  [[nodiscard]] ExperimentRig at(std::uint64_t occasion) const;
  /// Returns the limits of the rig for the menu of experiments.
  /// @param gain_mm_per_kpa  gain of the finger in the logs; it limits the displacement; 0: unknown.
  /// @param known_kpa  the largest pressure of the logs. At higher pressures, a smaller share of the
  /// displacement range is used.
  [[nodiscard]] sysid::RigLimits limits(double gain_mm_per_kpa, double known_kpa) const;
};

/// Returns the channel with this name, or the only channel if the name is empty. The error is a sentence.
[[nodiscard]] tl::expected<ExperimentRig, std::string> experiment_rig(rig::RigFile rig,
                                                                      const std::string& channel);

/// Plays one sequence text and returns the path of its recording: `folder`/NAME.
[[nodiscard]] tl::expected<std::string, NotPlayed> run_on(const ExperimentRig& rig, const std::string& name,
                                                          const std::string& sequence_yaml,
                                                          const std::string& folder);

/// Plays one sequence text and returns the log of the rig's channel.
[[nodiscard]] tl::expected<sysid::Log, NotPlayed> played_on(const ExperimentRig& rig, const std::string& name,
                                                            const std::string& sequence_yaml,
                                                            const std::string& folder);

/// Called before any motion with a sentence that describes it. The motion is allowed only if it returns true.
using Consent = std::function<bool(const std::string& what)>;

/// Returns a player that runs the experiments in the foreground as `softgrip run` does. A signal vents the
/// rig and stops the investigation.
[[nodiscard]] Player rig_player(ExperimentRig rig, Consent consent);

/// Returns a player that calls `COMMAND COMMAND_CSV LOG_OUT`. The file COMMAND_CSV has the columns time_s and
/// pressure_command_kpa with one row per `interval_s`. The command writes a log to LOG_OUT.
[[nodiscard]] Player command_player(std::string command, double interval_s, Consent consent);

/// Returns a function that checks the sensor of a simulated rig. Known lengths pass through the sensor blocks
/// of the simulated model, with the rig's noise and quantisation. Lengths outside the range of the sensor are
/// omitted.
[[nodiscard]] GaugeTaker simulated_gauge(ExperimentRig rig);

/// Returns a function that checks a sensor by calling `COMMAND POSITIONS_CSV GAUGE_OUT`.
[[nodiscard]] GaugeTaker command_gauge(std::string command, Consent consent);

/// Writes the readings to `folder`/gauge.csv and reads this file in the same way as any other gauge file.
[[nodiscard]] tl::expected<sysid::GaugeFile, NotPlayed> gauge_file_of(
    const std::vector<sysid::GaugeReading>& readings, const std::string& folder);

}  // namespace softgrip::tools
