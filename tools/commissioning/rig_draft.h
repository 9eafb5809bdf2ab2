#pragma once
// Creates the rig-file template of `softgrip init` from the answers of the user.
// Lists the values that the template of a rig file needs, for example the board. The user gives each value by
// an option, or by the answer to a question.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "document/problem.h"
#include "drivers/board/board_map.h"
#include "model/model.h"

namespace softgrip::tools {

/// A module of the board: its board file and its position in the rig.
struct DraftModule {
  std::string path;
  drivers::BoardMap map;
};

/// The answers of the user. Terminals are used in the order of their numbers: valve i is connected to output
/// i, sensor i to input i, and the pressure monitors to the last inputs.
struct RigDraft {
  std::string name = "my_rig";
  std::optional<double> rate_hz;     ///< control rate [Hz]; nullopt: the highest of the usual rates that is
                                     ///< valid for the rig
  std::vector<DraftModule> modules;  ///< modules of the board; empty: the board is simulated in the process
  std::string host;  ///< numeric address of a board on the network; empty: the board is on a serial line
  int port = 502;
  std::string device;  ///< path of the serial device to which the board is connected
  int baud = 9600;
  int unit = 1;  ///< unit id of the first module; the id of each next module is larger by 1
  std::vector<std::string> fingers{"left", "right"};
  std::string model_path;
  model::Model model;
  drivers::TwoPoints valve{0, 0, 10, 100};   ///< two points of the valve: electrical value at the terminal
                                             ///< (x) and pressure in kPa (y)
  drivers::TwoPoints sensor{0, -5, 10, 45};  ///< two points of the sensor: electrical value at the terminal
                                             ///< (x) and displacement in mm (y)
  double pressure_max_kpa = 60;
  bool monitor = true;  ///< true: each finger has a pressure monitor with the scaling of its valve
  bool accepts_no_watchdog = false;
  std::string sequences_path;
  bool service = false;  ///< true: the rig file uses the folders of the system service
};

/// Returns the module whose outputs are connected to the valves; null if no module has outputs or if the
/// board is simulated. The function input_module() returns the module whose inputs are connected to the
/// sensors.
[[nodiscard]] const DraftModule* output_module(const RigDraft& draft) noexcept;
[[nodiscard]] const DraftModule* input_module(const RigDraft& draft) noexcept;
/// Returns the largest number of fingers for which the board has a sufficient number of terminals. If
/// `monitor` is true, each finger needs one additional input.
[[nodiscard]] std::size_t most_fingers(const RigDraft& draft, bool monitor) noexcept;
/// Signal range of a valve or sensor at a terminal. The usual range is 0 to 10 V or 4 to 20 mA. For a
/// terminal in kilopascals, it is the range of the terminal.
struct ElectricalRange {
  double lowest = 0;
  double highest = 10;
};
[[nodiscard]] ElectricalRange output_range(const RigDraft& draft);
[[nodiscard]] ElectricalRange input_range(const RigDraft& draft);
[[nodiscard]] drivers::ElectricalUnit output_unit(const RigDraft& draft) noexcept;
[[nodiscard]] drivers::ElectricalUnit input_unit(const RigDraft& draft) noexcept;
/// Returns true if the module of the valves has a watchdog, which vents when communication stops. Also
/// returns true for a simulated board.
[[nodiscard]] bool has_watchdog(const RigDraft& draft) noexcept;

/// Returns the text of a rig file with comments, for the path `path`. The rig-file reader checks the text. If
/// the reader finds problems, returns the problems instead. Paths below the rig file's folder are relative to
/// this folder.
[[nodiscard]] tl::expected<std::string, document::Problems> draft_text(const RigDraft& draft,
                                                                       const std::string& path);

/// One value that the template of the rig file needs.
struct Fact {
  std::string key;    ///< name of the option, for example "board"
  std::string about;  ///< help text of the option
  int words = 1;      ///< number of words after the option; an option with one word may occur several times
  /// Returns the question and its default answer. Both depend on the values that the draft already contains.
  /// Returns nullopt if no question is needed.
  struct Question {
    std::string text;
    std::string otherwise;  ///< default answer; empty: the question has no default answer
  };
  std::optional<Question> (*question)(const RigDraft& draft);
  /// Stores the value in `draft`. Returns "" if the value is valid, otherwise an error message.
  std::string (*take)(const std::string& words, RigDraft& draft);
};

/// Returns all values in an order in which a value depends on earlier values and on no later value.
[[nodiscard]] const std::vector<Fact>& draft_facts();

}  // namespace softgrip::tools
