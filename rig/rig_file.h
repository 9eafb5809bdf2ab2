#pragma once
// Rig files: everything softgripd must know of a rig, read once into plain values.
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

/// What a valve does when its power fails: a property of the valve, told at the start.
enum class PowerLoss : std::uint8_t { vents, holds };

/// What is known of a channel's valve besides its wiring.
struct ValveFacts {
  double range_min_kpa = 0;  ///< what the valve can control, whatever the limits allow
  double range_max_kpa = 0;
  PowerLoss on_power_loss = PowerLoss::vents;
  double power_loss_kpa = 0;  ///< where a valve that vents goes when its power fails
};

/// A file that the rig depends on, as it was read: for hashes in the recording's provenance.
struct InputFile {
  enum class Role : std::uint8_t { rig, board, model, plant };
  Role role = Role::rig;
  std::string path;
  std::string text;
};

/// A rig file. Valid ones come from load_rig(): the settings satisfy control::settings_problems(), every
/// feedforward was accepted by control::check_feedforward(), the wiring fits the board.
struct RigFile {
  std::string name;
  std::string path;                            ///< as the user named it
  control::RigSettings settings;               ///< channels in the order of the file
  std::vector<ValveFacts> valves;              ///< one per channel
  std::vector<drivers::ChannelWiring> wiring;  ///< one per channel, as the file says, on every board
  std::variant<simulation::SimulatedBoardSettings, drivers::ModbusSettings, drivers::IioSettings> board;
  std::optional<std::uint64_t> seed;  ///< of a simulated board, as written
  /// The sentence by which the file accepts a board that does not vent by itself; empty: it has a watchdog.
  std::string accept_no_watchdog;
  /// The file takes a rate that the bus budget does not allow; without it such a file is refused.
  bool accept_over_budget = false;
  LoopSettings loop;
  ReconnectSettings reconnect;
  RealTimeSettings real_time;
  RecorderSettings recorder;  ///< paths made absolute or relative to the working directory
  SocketSettings socket;
  std::optional<GpioSettings> gpio;
  std::vector<InputFile> inputs;  ///< the rig file first, each file once
};

/// The sentence that `accept_no_watchdog` must hold, word by word.
inline constexpr std::string_view no_watchdog_words =
    "the outputs keep their last pressure when softgripd dies";

/// Reads a rig out of a parsed document. Files that it names (board map, models) are found relative to the
/// document's file; their own problems are added under their own names. Errors: nothing is returned.
/// Warnings: `problems.warnings()`, and the rig is returned.
[[nodiscard]] std::optional<RigFile> read_rig(const document::Document& document,
                                              document::Problems& problems);

/// A rig file as far as it could be read, for those who judge what goes with it although it has errors
/// itself.
struct RigReading {
  RigFile rig;
  bool accepted = false;  ///< no error: `rig` is what read_rig() returns
  /// Names of all channels, rate, detection and rest are known: sequences can be fitted to `rig.settings`,
  /// apart from the channels whose motion is not known.
  bool fits_sequences = false;
  std::vector<bool> motion_known;  ///< one per channel: model, feedforward, gains and limits are known
};
/// read_rig(), but with what is known of a rig that is refused.
[[nodiscard]] RigReading read_rig_so_far(const document::Document& document, document::Problems& problems);

/// parse_file() and read_rig().
[[nodiscard]] std::optional<RigFile> load_rig(const std::string& path, document::Problems& problems);

/// Gives the simulated plants other seeds, as if `seed` stood in the file. False if the board is not
/// simulated.
bool reseed(RigFile& rig, std::uint64_t seed);

}  // namespace softgrip::rig
