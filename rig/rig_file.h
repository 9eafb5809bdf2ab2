#pragma once
// Reads rig files: all settings of softgripd for one rig, as plain values. docs/reference/rig-file.md
// describes the file, and config/rig.yaml and config/rig_tcp.yaml are examples.
// Reads a rig from stored texts of its files, without access to the files.
// Finds the socket of the daemon that runs a rig. The clients of the daemon use this function.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/enum_table.h"
#include "control/tick/settings.h"
#include "document/node.h"
#include "document/problem.h"
#include "drivers/board/channel_wiring.h"
#include "drivers/iio/iio_board.h"
#include "drivers/modbus/modbus_board.h"
#include "rig/daemon_settings.h"
#include "simulation/plant/simulated_board.h"

namespace softgrip::rig {

/// Behaviour of a valve when its power fails: it vents, or it holds the pressure. The daemon reports the
/// behaviour at start-up.
enum class PowerLoss : std::uint8_t { vents, holds };
inline constexpr auto power_loss_names =
    enum_names<PowerLoss>({{PowerLoss::vents, "vents"}, {PowerLoss::holds, "holds"}});

/// Properties of a channel's valve that do not depend on its wiring.
struct ValveFacts {
  double range_min_kpa = 0;  ///< lower end of the pressure range that the valve can control [kPa]; the limits
                             ///< of the rig may be narrower than this range
  double range_max_kpa = 0;
  PowerLoss on_power_loss = PowerLoss::vents;
  double power_loss_kpa = 0;  ///< pressure after a power failure [kPa], if the valve vents
};

/// A file on which the rig depends, and the text that was read from it. Recordings contain the hash of the
/// text.
struct InputFile {
  enum class Role : std::uint8_t { rig, board, model, plant };
  Role role = Role::rig;
  std::string path;
  std::string text;
};

/// The contents of a rig file. load_rig() returns valid contents only: control::settings_problems() finds no
/// problem in the settings, control::check_feedforward() accepts each feedforward, and the wiring fits the
/// board.
struct RigFile {
  std::string name;
  std::string path;                ///< path of the rig file, as the user gave it
  control::RigSettings settings;   ///< settings of the controller, with the channels in the order of the file
  std::vector<ValveFacts> valves;  ///< properties of the valves, one entry per channel
  std::vector<drivers::ChannelWiring> wiring;  ///< wiring of the channels, one entry per channel, for every
                                               ///< kind of board
  std::variant<simulation::SimulatedBoardSettings, drivers::ModbusSettings, drivers::IioSettings> board;
  std::optional<std::uint64_t> seed;  ///< seed of a simulated board from the file; empty if the file contains
                                      ///< no seed
  /// Text of the key `accept_no_watchdog`, by which the user accepts a board that does not vent when messages
  /// stop. The text is empty if the file does not have the key.
  std::string accept_no_watchdog;
  /// true: the user accepts a rate that the bus may not reach; false: such a rate is an error
  bool accept_over_budget = false;
  LoopSettings loop;
  ReconnectSettings reconnect;
  RealTimeSettings real_time;
  RecorderSettings recorder;  ///< settings of the recorder; paths are absolute, or relative to the working
                              ///< directory
  SocketSettings socket;
  std::optional<GpioSettings> gpio;
  std::vector<InputFile> inputs;  ///< all files that were read, each file once; the rig file is the first
};

/// The sentence that a user must copy word for word into the value of `accept_no_watchdog`.
inline constexpr std::string_view no_watchdog_words =
    "the outputs keep their last pressure when softgripd dies";

/// Reads a rig from a parsed document. The paths of board maps and models in the document are relative to the
/// folder of the document. A problem in a board map or a model is reported with the path of this file.
/// Returns nothing if there is an error. If there are warnings but no errors, returns the rig; the warnings
/// are in `problems.warnings()`.
[[nodiscard]] std::optional<RigFile> read_rig(const document::Document& document,
                                              document::Problems& problems);

/// The readable part of a rig file. If a rig has errors, sequences are checked with its readable part.
struct RigReading {
  RigFile rig;
  bool accepted = false;  ///< true: the file has no error, so read_rig() would return `rig`
  /// true: the names of all channels, the rate, the detection settings and the rest settings are known. In
  /// this case, sequences can be checked with `rig.settings`, except for channels whose `motion_known` is
  /// false.
  bool fits_sequences = false;
  std::vector<bool> motion_known;  ///< one value per channel; true: model, feedforward, gains and limits are
                                   ///< known
};
/// Reads a rig as read_rig() does. If the rig has errors, returns the readable part of the rig.
[[nodiscard]] RigReading read_rig_so_far(const document::Document& document, document::Problems& problems);

/// Reads a rig from a file, with parse_file() and read_rig().
[[nodiscard]] std::optional<RigFile> load_rig(const std::string& path, document::Problems& problems);

/// Replaces the seeds of the simulated fingers by the seeds that they would have if the rig file contained
/// this `seed`. Returns false if the board is not simulated.
bool reseed(RigFile& rig, std::uint64_t seed);

/// Reads a rig from the stored texts of its files (RigFile::inputs), without access to the disk. Reports the
/// same problems as load_rig() reports for the files.
[[nodiscard]] std::optional<RigFile> read_stored_rig(const std::vector<InputFile>& inputs,
                                                     document::Problems& problems);

/// Returns the value of `socket: path:` in a rig file, as a path relative to the working directory. The other
/// keys of the file are not checked, because the daemon may run with an earlier version of the file. If the
/// file cannot be read or has no such path, a problem is reported.
[[nodiscard]] std::optional<std::string> socket_path_of(const std::string& rig_path,
                                                        document::Problems& problems);

}  // namespace softgrip::rig
