#pragma once
// The examinations of `softgrip doctor`: computer, rig, bus, daemon and gateways.

#include <memory>
#include <string>
#include <string_view>

#include "tools/commissioning/finding.h"
#include "tools/commissioning/motion_session.h"

namespace softgrip::rig {
struct RigFile;
}

namespace softgrip::tools::doctor {

/// Checks the kernel, the permissions for real-time scheduling and locked memory, and the timer. Requests
/// real-time scheduling and locked memory for this process in the same way as the daemon. Takes about 1 s.
void examine_machine(const rig::RigFile& rig, Findings& findings);
/// Checks that the clock is plausible and synchronised.
void examine_clock(Findings& findings);
/// Checks that the disk has enough space for the recordings of the rig.
void examine_disk(const rig::RigFile& rig, Findings& findings);

/// Sizes and durations of the motions of an examination.
struct MoveSettings {
  double share = 0.25;    ///< commanded step, as a share of the pressure difference between rest and the
                          ///< pressure limit that is farther from rest
  double duration_s = 1;  ///< duration of the ramp up and of the ramp down [s]; the ramps take longer if the
                          ///< slew limits require it
  double settle_s = 1;    ///< wait after the ramp up and after the ramp down [s]
  double look_s = 1;      ///< duration of the measurement at rest before the first motion [s]
};

/// Examines board, watchdog, bus budget and sensors. If `move` is set, also moves each finger a little and
/// compares the motion with the finger's model. At the end, the channels are at their rest pressures. If the
/// user stops the examination, the stop counts as a failure. `lines` are the digital lines of the rig, see
/// MotionSession. Calls `silent` at most once, as MotionSession::leave() does: if the board stops responding
/// after the measurement at rest, before the ramp to the rest pressures has ended.
void examine_rig(const rig::RigFile& rig, drivers::Board& board, const Clock& clock, StopRequest stop,
                 bool move, const MoveSettings& settings, Findings& findings,
                 drivers::GpioLines* lines = nullptr, const MotionSession::Warn& silent = {});

/// Adds the finding that the displacement sensor of a channel is not used.
void tell_unused_sensor(const std::string& channel, Findings& findings);

/// A reading of the pressure monitor of a channel.
struct MonitorReading {
  double pressure_kpa = 0;       ///< NaN: no reading is valid
  double command_kpa = 0;        ///< commanded pressure
  double pressure_span_kpa = 0;  ///< difference between the pressure limits of the channel
  bool at_rest = true;           ///< false: the command may have changed, so the pressure may differ from it
  std::string text;              ///< description of a valid reading
};
/// Judges the pressure monitor of a channel.
void judge_monitor(const std::string& channel, const MonitorReading& reading, Findings& findings);

/// Examines the digital lines: requests them from the operating system and reads them. The digital outputs
/// become inactive. Returns the lines; nullptr if the rig has no lines or if they are not available.
[[nodiscard]] std::unique_ptr<drivers::GpioLines> examine_gpio(const rig::RigFile& rig, Findings& findings);

/// Examines the bus budget and the watchdog from the rig and board files, without an exchange with the board.
void examine_description(const rig::RigFile& rig, const drivers::Board& board, Findings& findings);

/// Returns true if the findings contain a failure of the board or of a sensor that other settings of the
/// module might correct.
[[nodiscard]] bool wants_bus_examination(const Findings& findings);

/// Reads the inputs of every module with the settings of the files, in a separate session. If the module does
/// not respond, or if a wired input is invalid, tries other unit ids, addresses, numbers of registers, word
/// orders and framings. Adds the finding "modbus NAME" with the cause and the next step. Adds nothing if all
/// wired inputs are valid, or if the cause is uncertain.
///
/// Writes nothing to the module and ends after 4 s. If read requests reset the board's watchdog, the
/// examination delays the trip of the watchdog by at most 4 s. The rig's board must not be connected.
void examine_bus(const rig::RigFile& rig, Findings& findings);

/// Returns the next step that the user should take after a bus failure. `failure_kind` is the name of a
/// drivers::BusStatus. The status of a running daemon also contains this name.
[[nodiscard]] std::string_view bus_advice(std::string_view failure_kind) noexcept;

/// Adds the findings about the daemon, its rig and its bus. `status` and `statistics` are the responses of
/// the daemon's socket. `rig` is the name of the rig in the rig file of the user; empty if the user gave no
/// rig file.
void examine_daemon(const nlohmann::ordered_json& status, const nlohmann::ordered_json& statistics,
                    const std::string& rig, Findings& findings);

/// Examines each gateway program that systemd starts, which is the case if its unit is in `units`, the folder
/// of enabled systemd units. Checks that the program's file in `configuration` is valid, and that a program
/// listens on the address in this file.
void examine_gateways(const std::string& units, const std::string& configuration, Findings& findings);

}  // namespace softgrip::tools::doctor
