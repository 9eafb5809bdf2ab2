#pragma once
// The parts that read_rig() is made of; each reads one map of a rig file. Internal to rig_file*.cpp.

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "document/reader.h"
#include "rig/rig_file.h"

namespace softgrip::rig {

using document::MapReader;

/// A module of the board, as far as it could be read.
struct KnownModule {
  std::string name;
  std::optional<drivers::ModuleTerminals> terminals;
};
/// A terminal of a module.
using UsedTerminals = std::map<std::pair<std::size_t, std::size_t>, document::Location>;

/// What is carried along while a rig file is read.
struct Context {
  const document::Document& document;
  document::Problems& problems;
  RigFile& rig;
  std::string board_key;                            ///< which kind of board it is
  std::vector<KnownModule> modules;                 ///< of a board with terminals
  std::vector<drivers::ChannelWiring> wiring;       ///< one per channel
  std::map<std::string, document::Location> names;  ///< of channels, and where each stands
  UsedTerminals inputs;
  UsedTerminals thermometers;  ///< those of the inputs that channels may share
  UsedTerminals outputs;
  std::map<std::string, std::optional<model::Model>> models;  ///< by path: each file is read once

  bool rate_known = false;  ///< rate_hz was good: what is compared with a cycle can be

  /// Which parts of the file are there and without an error: what compares several is done where all of them
  /// are.
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
  /// One per channel: model, feedforward, gains and limits are known.
  std::vector<bool> motion_known;
  /// Where the files that the rig names come from; null: from the disk.
  const std::vector<InputFile>* stored = nullptr;

  /// A time of the session with a Modbus board that must be below a deadline, which is read later.
  struct Wait {
    document::Location at;
    std::string_view key;
    double value_s = 0;
    std::string_view deadline;
  };
  std::vector<Wait> waits{};

  [[nodiscard]] double period_s() const { return 1 / rig.settings.rate_hz; }
};

/// A path of the rig file as seen from the working directory.
[[nodiscard]] std::string resolved(const Context& context, const std::string& path);
/// The document in the file that `key` names; a file that cannot be read is reported at the key.
[[nodiscard]] std::optional<document::Document> named_document(Context& context, MapReader& reader,
                                                               std::string_view key, InputFile::Role role);
/// The model in the file that `key` names.
[[nodiscard]] std::optional<model::Model> named_model(Context& context, MapReader& reader,
                                                      std::string_view key, InputFile::Role role);

/// A name that is good for folders, metrics and messages: letters, digits, `-` and `_`.
[[nodiscard]] std::string read_name(MapReader& reader, std::string_view key);
/// "12:5"
[[nodiscard]] std::string place(document::Location at);
/// "`key` is already ... at 12:5"
void report_repeated(MapReader& reader, std::string_view key, const std::string& what,
                     document::Location first);

/// The maps at the top of the file.
void read_modbus_tcp(Context& context, const document::Node& node);
void read_modbus_rtu(Context& context, const document::Node& node);
void read_iio(Context& context, const document::Node& node);
/// Of a board that takes its time: how long exchanges may take, how a lost session is made anew.
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

/// Maps that may stand at the top, for all channels, or in a channel, for itself.
[[nodiscard]] control::PlausibilitySettings read_plausibility(Context& context, const document::Node& node);
[[nodiscard]] control::ModelHealthSettings read_model_health(Context& context, const document::Node& node);

/// Returns 0 kPa if the limits only keep a channel from it at rest; else the rest pressure.
[[nodiscard]] double vented_kpa(const control::LimitSettings& limits);
/// True if a pressure is the rest pressure, within 1 % of the range, or between it and vented_kpa().
[[nodiscard]] bool is_rest(const control::LimitSettings& limits, double pressure_kpa);

/// How a channel is wired. `rest_stated`: the file gives the channel's `rest_kpa`.
[[nodiscard]] drivers::OutputWiring read_valve(Context& context, const document::Node& node,
                                               const std::string& who, const control::LimitSettings& limits,
                                               bool rest_stated, ValveFacts& facts);
[[nodiscard]] drivers::InputWiring read_sensor(Context& context, const document::Node& node,
                                               const std::string& who, const control::LimitSettings& limits);
[[nodiscard]] drivers::InputWiring read_pressure_monitor(Context& context, const document::Node& node,
                                                         const std::string& who);
/// Channels may share one.
[[nodiscard]] drivers::InputWiring read_temperature_sensor(Context& context, const document::Node& node,
                                                           const std::string& who);

/// What only several parts of a rig show: the wiring, the watchdog, what control makes of the settings, the
/// bus budget; each as soon as the parts that it takes are sound.
void check_whole(Context& context, MapReader& top);
/// Whether the board puts every channel to its rest pressure by itself.
[[nodiscard]] bool board_vents_when_silent(const Context& context);

}  // namespace softgrip::rig
