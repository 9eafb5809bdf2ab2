#pragma once
// The functions by which read_rig() reads the maps of a rig file. Only rig_file*.cpp uses this file.
// Reads the map `channel_defaults` of a rig file, which contains the keys that all channels share.

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "document/schema.h"
#include "rig/rig_file.h"
#include "rig/rig_keys.h"

namespace softgrip::rig {

using document::MapReader;

/// The data of a board's module that could be read from the rig file.
struct KnownModule {
  std::string name;
  std::optional<drivers::ModuleTerminals> terminals;
};
/// Location in the file of each terminal that is already in use. The key is the module and the number of the
/// terminal.
using UsedTerminals = std::map<std::pair<std::size_t, std::size_t>, document::Location>;

/// The state that all functions share while a rig file is read.
struct Context {
  const document::Document& document;
  document::Problems& problems;
  RigFile& rig;
  std::string board_key;                            ///< key that gives the kind of the board, such as
                                                    ///< "modbus_tcp"
  std::vector<KnownModule> modules;                 ///< modules of the board; empty for a simulated board
  std::vector<drivers::ChannelWiring> wiring;       ///< wiring of the channels, one entry per channel
  std::map<std::string, document::Location> names;  ///< names of the channels, with their locations in the
                                                    ///< file
  UsedTerminals inputs;
  UsedTerminals thermometers;  ///< inputs for temperature sensors; several channels may share such an input
  UsedTerminals outputs;
  std::map<std::string, std::optional<model::Model>> models;  ///< models by path, so that each file is read
                                                              ///< only once

  bool rate_known = false;  ///< true: rate_hz has no error, so other values can be compared with the period

  /// Has one member for each part of the file. A member is true if its part is present and has no error;
  /// `loop` is also true if this optional part is absent. A check that needs several parts runs if all of
  /// these parts have no error.
  struct Sound {
    bool loop = false;
    bool faults = false;
    bool board = false;
    bool channels = false;
    bool safety = false;
    bool detection = false;
    bool rest = false;
  };
  Sound sound;
  /// One value per channel; true: model, feedforward, gains and limits of the channel are known.
  std::vector<bool> motion_known;
  /// Texts of the files to which the rig refers. If the pointer is null, these files are read from the disk.
  const std::vector<InputFile>* stored = nullptr;

  /// A waiting time of a Modbus session, stored because it must be shorter than a deadline that is read
  /// later.
  struct Wait {
    document::Location at;
    std::string_view key;
    double value_s = 0;
    std::string_view deadline;
  };
  std::vector<Wait> waits{};

  [[nodiscard]] double period_s() const { return 1 / rig.settings.rate_hz; }
};

/// Converts a path in the rig file to a path relative to the working directory.
[[nodiscard]] std::string resolved(const Context& context, const std::string& path);
/// Reads the document whose path is the value of `key`. If the file cannot be read, a problem is reported at
/// the key.
[[nodiscard]] std::optional<document::Document> named_document(Context& context, MapReader& reader,
                                                               std::string_view key, InputFile::Role role);
/// Reads the model in the file whose path is the value of `key`.
[[nodiscard]] std::optional<model::Model> named_model(Context& context, MapReader& reader,
                                                      std::string_view key, InputFile::Role role);

/// Reads a name that can be used in folders, metrics and messages: letters, digits, `-` and `_`.
[[nodiscard]] std::string read_name(MapReader& reader, std::string_view key);
/// Reports at `key` that `what` is already used: "WHAT is already used at 12:5", where 12:5 is the location
/// `first`.
void report_repeated(MapReader& reader, std::string_view key, const std::string& what,
                     document::Location first);

// Each of the following functions reads one map of the file.
void read_modbus_tcp(Context& context, const document::Node& node);
void read_modbus_rtu(Context& context, const document::Node& node);
void read_iio(Context& context, const document::Node& node);
/// Reads the deadlines for connecting and for an exchange, and the pauses between attempts to connect.
void read_timing(Context& context, MapReader& board);
void read_channels(Context& context, MapReader& top);
void read_simulated_board(Context& context, const document::Node& node);
void read_safety(Context& context, MapReader& top);
void read_faults(Context& context, MapReader& top);
void read_detection(Context& context, MapReader& top);
void read_rest(Context& context, MapReader& top);
void read_loop(Context& context, MapReader& top);
void read_real_time(Context& context, MapReader& top);
void read_recorder(Context& context, MapReader& top);
void read_socket(Context& context, MapReader& top);
void read_gpio(Context& context, MapReader& top);

/// Returns 0 kPa if the pressure range does not contain 0 kPa and the rest pressure is the end of the range
/// nearest to 0 kPa. Otherwise returns the rest pressure.
[[nodiscard]] double vented_kpa(const control::LimitSettings& limits);
/// Returns true if a pressure is between the rest pressure and vented_kpa(). A distance from this interval of
/// up to 1 % of the pressure range is permitted.
[[nodiscard]] bool is_rest(const control::LimitSettings& limits, double pressure_kpa);

// Each of the following functions reads one part of the wiring of a channel.
/// Reads the valve. `rest_stated` is true if the file gives `rest_kpa` for the channel.
[[nodiscard]] drivers::OutputWiring read_valve(Context& context, const document::Node& node,
                                               const std::string& who, const control::LimitSettings& limits,
                                               bool rest_stated, ValveFacts& facts);
[[nodiscard]] drivers::InputWiring read_sensor(Context& context, const document::Node& node,
                                               const std::string& who, const control::LimitSettings& limits);
[[nodiscard]] drivers::InputWiring read_pressure_monitor(Context& context, const document::Node& node,
                                                         const std::string& who);
/// Reads the temperature sensor, which several channels may share.
[[nodiscard]] drivers::InputWiring read_temperature_sensor(Context& context, const document::Node& node,
                                                           const std::string& who);

/// Checks the wiring, the watchdog, the settings of the controller and the bus budget. Each check runs if the
/// parts of the file that the check needs have no error.
void check_whole(Context& context, MapReader& top);
/// Returns true if the board puts each channel to its rest pressure when messages stop.
[[nodiscard]] bool board_vents_when_silent(const Context& context);

/// Completes the channels of a rig file: a key that a channel omits is taken from `channel_defaults`. Maps
/// are merged key by key. For example, a channel with `valve: {output: 0}` gets the scaling from `valve` in
/// the defaults. Lists are not merged. Nodes keep their locations in the file, so an error in a default is
/// reported once, at the location of the default.
class ChannelDefaults {
 public:
  /// Reports keys that cannot be defaults: the key `name`, and keys that apply to all channels and belong at
  /// the top level of the file.
  ChannelDefaults(Context& context, MapReader& top);

  /// Returns the channel with the default added for each key that the channel omits.
  [[nodiscard]] document::Node completed(const document::Node& channel);

  /// Marks the defaults that caused a problem with an index of at least `before`. The problems of these
  /// defaults are not reported a second time for the next channel.
  void settle(std::size_t before);

  /// Returns true if a default has an error. In this case, no channel can be checked completely.
  [[nodiscard]] bool spoiled() const noexcept { return spoiled_; }

 private:
  void fill(document::Node& own, const document::Node& shared);

  Context& context_;
  document::Node shared_;
  bool spoiled_ = false;
};

}  // namespace softgrip::rig
