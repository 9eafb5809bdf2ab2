#pragma once
// Functions that read_rig() calls to read the maps of a rig file. Internal to rig_file*.cpp.

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "document/reader.h"
#include "rig/rig_file.h"

namespace softgrip::rig {

using document::MapReader;

/// The readable part of a module of the board.
struct KnownModule {
  std::string name;
  std::optional<drivers::ModuleTerminals> terminals;
};
/// Places of the terminals that are in use, by module and number.
using UsedTerminals = std::map<std::pair<std::size_t, std::size_t>, document::Location>;

/// State that the functions share while they read a rig file.
struct Context {
  const document::Document& document;
  document::Problems& problems;
  RigFile& rig;
  std::string board_key;                            ///< key of the board's kind, such as "modbus_tcp"
  std::vector<KnownModule> modules;                 ///< modules of the board; empty for a simulated board
  std::vector<drivers::ChannelWiring> wiring;       ///< one per channel
  std::map<std::string, document::Location> names;  ///< names of channels, and their places in the file
  UsedTerminals inputs;
  UsedTerminals thermometers;  ///< inputs of temperature sensors, which several channels may share
  UsedTerminals outputs;
  std::map<std::string, std::optional<model::Model>> models;  ///< by path, so that each file is read once

  bool rate_known = false;  ///< rate_hz has no error, so values can be compared with the period

  /// True for each part of the file that is present and has no error. A check that needs several parts runs
  /// only if they all have no error.
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
  /// One per channel: true if model, feedforward, gains and limits are known.
  std::vector<bool> motion_known;
  /// Texts of the files to which the rig refers; if it is null, the files are read from the disk.
  const std::vector<InputFile>* stored = nullptr;

  /// A waiting time of a Modbus session that must be below a deadline, which is read later.
  struct Wait {
    document::Location at;
    std::string_view key;
    double value_s = 0;
    std::string_view deadline;
  };
  std::vector<Wait> waits{};

  [[nodiscard]] double period_s() const { return 1 / rig.settings.rate_hz; }
};

/// Returns a path in the rig file relative to the working directory.
[[nodiscard]] std::string resolved(const Context& context, const std::string& path);
/// Reads the document in the file whose path is the value of `key`. If the file cannot be read, a problem is
/// reported at the key.
[[nodiscard]] std::optional<document::Document> named_document(Context& context, MapReader& reader,
                                                               std::string_view key, InputFile::Role role);
/// Reads the model in the file whose path is the value of `key`.
[[nodiscard]] std::optional<model::Model> named_model(Context& context, MapReader& reader,
                                                      std::string_view key, InputFile::Role role);

/// Reads a name that can be used in folders, metrics and messages: letters, digits, `-` and `_`.
[[nodiscard]] std::string read_name(MapReader& reader, std::string_view key);
/// Returns a place as text, for example "12:5".
[[nodiscard]] std::string place(document::Location at);
/// Reports "`key` is already ... at 12:5".
void report_repeated(MapReader& reader, std::string_view key, const std::string& what,
                     document::Location first);

// Each of the following functions reads one map of the file.
void read_modbus_tcp(Context& context, const document::Node& node);
void read_modbus_rtu(Context& context, const document::Node& node);
void read_iio(Context& context, const document::Node& node);
/// Reads the deadlines of connecting and exchanging, and the pauses between attempts to connect.
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

// The following two maps are at the top of the file, for all channels, or in a channel.
[[nodiscard]] control::PlausibilitySettings read_plausibility(Context& context, const document::Node& node);
[[nodiscard]] control::ModelHealthSettings read_model_health(Context& context, const document::Node& node);

/// Returns 0 kPa if the rest pressure differs from 0 kPa only because the pressure limits exclude 0 kPa;
/// otherwise the rest pressure.
[[nodiscard]] double vented_kpa(const control::LimitSettings& limits);
/// Returns true if a pressure lies between the rest pressure and vented_kpa(), or differs from this interval
/// by at most 1 % of the pressure range.
[[nodiscard]] bool is_rest(const control::LimitSettings& limits, double pressure_kpa);

// Each of the following functions reads one part of the wiring of a channel.
/// Reads the valve. `rest_stated` is true if the file contains the channel's `rest_kpa`.
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

/// Checks the wiring, the watchdog, the settings of the controller and the bus budget. Each check runs only
/// if the parts of the file that it needs have no error.
void check_whole(Context& context, MapReader& top);
/// Returns true if the board puts each channel to its rest pressure when messages stop.
[[nodiscard]] bool board_vents_when_silent(const Context& context);

}  // namespace softgrip::rig
