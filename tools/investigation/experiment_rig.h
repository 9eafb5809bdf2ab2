#pragma once
// What an investigation plays its experiments on: a rig file's rig through the daemon's own code, or a
// command of the user's.

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

/// One channel of a rig file's rig.
struct ExperimentRig {
  rig::RigFile rig;
  std::size_t channel = 0;
  bool simulated = false;  ///< in process: nothing moves, time is virtual
  /// Plays the sequences. A test may give one with another clock and another board.
  daemon::DaemonRunner run = daemon::run_daemon;

  [[nodiscard]] const std::string& channel_name() const { return rig.settings.channels[channel].name; }
  /// The same rig on another occasion: a simulated one draws other noise, a real one does so by itself.
  [[nodiscard]] ExperimentRig at(std::uint64_t occasion) const;
  /// What the menu may ask of it. @param gain_mm_per_kpa  of the logs, keeps the finger inside its
  /// displacement range; 0: unknown. @param known_kpa  the largest pressure of the logs, beyond which less of
  /// it is used.
  [[nodiscard]] sysid::RigLimits limits(double gain_mm_per_kpa, double known_kpa) const;
};

/// The channel of that name, the only one where none is named, or a sentence.
[[nodiscard]] tl::expected<ExperimentRig, std::string> experiment_rig(rig::RigFile rig,
                                                                      const std::string& channel);

/// Plays one sequence text and returns where its recording is: `folder`/NAME.
[[nodiscard]] tl::expected<std::string, NotPlayed> run_on(const ExperimentRig& rig, const std::string& name,
                                                          const std::string& sequence_yaml,
                                                          const std::string& folder);

/// The same, and the rig's channel read from that recording.
[[nodiscard]] tl::expected<sysid::Log, NotPlayed> played_on(const ExperimentRig& rig, const std::string& name,
                                                            const std::string& sequence_yaml,
                                                            const std::string& folder);

/// Asked before anything moves, with a sentence that says what will. False: it does not move.
using Consent = std::function<bool(const std::string& what)>;

/// Plays in the foreground as `softgrip run` does; a signal vents the rig and stops the investigation.
[[nodiscard]] Player rig_player(ExperimentRig rig, Consent consent);

/// Plays by calling `COMMAND COMMAND_CSV LOG_OUT`: time_s, pressure_command_kpa every `interval_s` in, a log
/// out.
[[nodiscard]] Player command_player(std::string command, double interval_s, Consent consent);

/// Checks the sensor of a simulated rig by itself: known lengths go through the sensor of the truth, with the
/// rig's noise and quantisation. Lengths that it cannot measure are left out.
[[nodiscard]] GaugeTaker simulated_gauge(ExperimentRig rig);

/// Checks a sensor by calling `COMMAND POSITIONS_CSV GAUGE_OUT`.
[[nodiscard]] GaugeTaker command_gauge(std::string command, Consent consent);

/// Writes what was read to `folder`/gauge.csv and reads it back as any other gauge file.
[[nodiscard]] tl::expected<sysid::GaugeFile, NotPlayed> gauge_file_of(
    const std::vector<sysid::GaugeReading>& readings, const std::string& folder);

}  // namespace softgrip::tools
