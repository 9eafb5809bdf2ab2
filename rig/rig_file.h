#pragma once
// Rig files: reads all settings of softgripd for one rig into plain values.
// docs/reference/rig-file.md is the manual of the file; config/rig.yaml and config/rig_tcp.yaml are examples.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "control/tick/settings.h"
#include "document/node.h"
#include "drivers/board/channel_wiring.h"
#include "drivers/iio/iio_board.h"
#include "drivers/modbus/modbus_board.h"
#include "rig/gpio_settings.h"
#include "rig/loop_settings.h"
#include "rig/real_time_settings.h"
#include "rig/recorder_settings.h"
#include "rig/socket_settings.h"
#include "simulation/plant/simulated_board.h"

namespace softgrip::rig {

/// Behaviour of a valve when its power fails. The daemon reports it at start-up.
enum class PowerLoss : std::uint8_t { vents, holds };

/// Properties of a channel's valve apart from its wiring.
struct ValveFacts {
  double range_min_kpa = 0;  ///< range that the valve controls, independent of the limits
  double range_max_kpa = 0;
  PowerLoss on_power_loss = PowerLoss::vents;
  double power_loss_kpa = 0;  ///< pressure after a power failure, for a valve that vents
};

/// A file on which the rig depends, with the text that was read. Recordings store the hash of the text.
struct InputFile {
  enum class Role : std::uint8_t { rig, board, model, plant };
  Role role = Role::rig;
  std::string path;
  std::string text;
};

/// The contents of a rig file. load_rig() returns only valid contents: control::settings_problems() finds no
/// problem in the settings, control::check_feedforward() accepts each feedforward, and the wiring matches the
/// board.
struct RigFile {
  std::string name;
  std::string path;                            ///< as the user named it
  control::RigSettings settings;               ///< channels in the order of the file
  std::vector<ValveFacts> valves;              ///< one per channel
  std::vector<drivers::ChannelWiring> wiring;  ///< one per channel, for each kind of board
  std::variant<simulation::SimulatedBoardSettings, drivers::ModbusSettings, drivers::IioSettings> board;
  std::optional<std::uint64_t> seed;  ///< seed of a simulated board, as in the file
  /// Text of `accept_no_watchdog`, with which the file accepts a board that does not vent by itself; empty if
  /// the file does not have this key.
  std::string accept_no_watchdog;
  /// The file accepts a rate that the bus may not reach. Otherwise such a rate is an error.
  bool accept_over_budget = false;
  LoopSettings loop;
  ReconnectSettings reconnect;
  RealTimeSettings real_time;
  RecorderSettings recorder;  ///< paths are absolute or relative to the working directory
  SocketSettings socket;
  std::optional<GpioSettings> gpio;
  std::vector<InputFile> inputs;  ///< the rig file first, each file once
};

/// The sentence that `accept_no_watchdog` must contain exactly.
inline constexpr std::string_view no_watchdog_words =
    "the outputs keep their last pressure when softgripd dies";

/// Reads a rig from a parsed document. Paths in the file (board map, models) are relative to the folder of
/// the document. Problems of these files are reported with their own paths. Returns nothing if there is an
/// error. If there are only warnings, which are in `problems.warnings()`, returns the rig.
[[nodiscard]] std::optional<RigFile> read_rig(const document::Document& document,
                                              document::Problems& problems);

/// The readable part of a rig file. If a rig has errors, sequences are checked with this part.
struct RigReading {
  RigFile rig;
  bool accepted = false;  ///< the file has no error, and read_rig() would return `rig`
  /// The names of all channels, the rate, the detection and the rest settings are known. Sequences can then
  /// be checked against `rig.settings`, except for channels whose motion is not known.
  bool fits_sequences = false;
  std::vector<bool> motion_known;  ///< one per channel: model, feedforward, gains and limits are known
};
/// Reads a rig as read_rig() does, but returns the readable part of a rig that has errors.
[[nodiscard]] RigReading read_rig_so_far(const document::Document& document, document::Problems& problems);

/// Calls parse_file() and read_rig().
[[nodiscard]] std::optional<RigFile> load_rig(const std::string& path, document::Problems& problems);

/// Changes the seeds of the simulated plants to those that a file with this `seed` would give. Returns false
/// if the board is not simulated.
bool reseed(RigFile& rig, std::uint64_t seed);

}  // namespace softgrip::rig
