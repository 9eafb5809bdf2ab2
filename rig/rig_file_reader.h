#pragma once
// Functions that read_rig() calls. Each reads one map of a rig file. Internal to rig_file*.cpp.

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
  std::string board_key;                            ///< the kind of board
  std::vector<KnownModule> modules;                 ///< modules of a board with terminals
  std::vector<drivers::ChannelWiring> wiring;       ///< one per channel
  std::map<std::string, document::Location> names;  ///< names of channels, and their places in the file
  UsedTerminals inputs;
  UsedTerminals thermometers;  ///< inputs that several channels may share
  UsedTerminals outputs;
  std::map<std::string, std::optional<model::Model>> models;  ///< by path, so that each file is read once

  bool rate_known = false;  ///< rate_hz has no error, so values can be compared with a cycle

  /// The parts of the file that are present without an error. A check of several parts runs only if all of
  /// them are.
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
  /// Texts of the files that the rig names; null: they are read from the disk.
  const std::vector<InputFile>* stored = nullptr;

  /// A time of the session with a Modbus board that must be below a deadline. The deadline is read later.
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
/// Reads the document in the file that `key` names. A file that cannot be read is reported at the key.
[[nodiscard]] std::optional<document::Document> named_document(Context& context, MapReader& reader,
                                                               std::string_view key, InputFile::Role role);
/// Reads the model in the file that `key` names.
[[nodiscard]] std::optional<model::Model> named_model(Context& context, MapReader& reader,
                                                      std::string_view key, InputFile::Role role);

/// Reads a name that can be used in folders, metrics and messages: letters, digits, `-` and `_`.
[[nodiscard]] std::string read_name(MapReader& reader, std::string_view key);
/// Returns a place as text, for example "12:5".
[[nodiscard]] std::string place(document::Location at);
/// Reports "`key` is already ... at 12:5".
void report_repeated(MapReader& reader, std::string_view key, const std::string& what,
                     document::Location first);

/// The following functions read the maps at the top of the file.
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

/// Reads maps that are either at the top of the file, for all channels, or in a channel.
[[nodiscard]] control::PlausibilitySettings read_plausibility(Context& context, const document::Node& node);
[[nodiscard]] control::ModelHealthSettings read_model_health(Context& context, const document::Node& node);

/// Returns 0 kPa if only the limits keep a resting channel from 0 kPa; otherwise the rest pressure.
[[nodiscard]] double vented_kpa(const control::LimitSettings& limits);
/// Returns true if a pressure is within 1 % of the range of the rest pressure, or between the rest pressure
/// and vented_kpa().
[[nodiscard]] bool is_rest(const control::LimitSettings& limits, double pressure_kpa);

/// Reads the wiring of a channel. `rest_stated`: the file gives the channel's `rest_kpa`.
[[nodiscard]] drivers::OutputWiring read_valve(Context& context, const document::Node& node,
                                               const std::string& who, const control::LimitSettings& limits,
                                               bool rest_stated, ValveFacts& facts);
[[nodiscard]] drivers::InputWiring read_sensor(Context& context, const document::Node& node,
                                               const std::string& who, const control::LimitSettings& limits);
[[nodiscard]] drivers::InputWiring read_pressure_monitor(Context& context, const document::Node& node,
                                                         const std::string& who);
/// Several channels may share one temperature sensor.
[[nodiscard]] drivers::InputWiring read_temperature_sensor(Context& context, const document::Node& node,
                                                           const std::string& who);

/// Checks the wiring, the watchdog, the settings of the control and the bus budget. Each check runs only if
/// the parts that it needs have no error.
void check_whole(Context& context, MapReader& top);
/// Returns true if the board puts each channel to its rest pressure when messages stop.
[[nodiscard]] bool board_vents_when_silent(const Context& context);

}  // namespace softgrip::rig
