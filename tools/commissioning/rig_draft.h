#pragma once
// A first rig file from a few facts: what `softgrip init` writes.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "document/problem.h"
#include "drivers/board/board_map.h"
#include "drivers/board/two_points.h"
#include "model/model.h"

namespace softgrip::tools {

/// A module of the board: its map, and where that is.
struct DraftModule {
  std::string path;
  drivers::BoardMap map;
};

/// The facts. Terminals are counted through: valve i on output i, sensor i on input i, the monitors on the
/// last inputs.
struct RigDraft {
  std::string name = "my_rig";
  std::optional<double> rate_hz;     ///< nothing: the highest usual one that is accepted
  std::vector<DraftModule> modules;  ///< empty: simulated in process
  std::string host;                  ///< of a board in the network, numeric; empty: on a serial line
  int port = 502;
  std::string device;  ///< of the serial line
  int baud = 9600;
  int unit = 1;  ///< of the first module; the others' count on
  std::vector<std::string> fingers{"left", "right"};
  std::string model_path;
  model::Model model;
  drivers::TwoPoints valve{0, 0, 10, 100};   ///< x: at the terminal, y: kPa
  drivers::TwoPoints sensor{0, -5, 10, 45};  ///< x: at the terminal, y: mm
  double pressure_max_kpa = 60;
  bool monitor = true;  ///< each finger has a pressure monitor, with the valve's points
  bool accepts_no_watchdog = false;
  std::string sequences_path;
  bool service = false;  ///< runs as the system service: its folders
};

/// The module whose outputs (inputs) are used; nothing if the board has none or is simulated.
[[nodiscard]] const DraftModule* output_module(const RigDraft& draft) noexcept;
[[nodiscard]] const DraftModule* input_module(const RigDraft& draft) noexcept;
/// How many fingers the terminals suffice for, with or without monitors.
[[nodiscard]] std::size_t most_fingers(const RigDraft& draft, bool monitor) noexcept;
/// The signal of an ordinary valve or sensor at such a terminal: 0 to 10 V, 4 to 20 mA; of a terminal that is
/// told kilopascals what it can deliver.
struct ElectricalRange {
  double lowest = 0;
  double highest = 10;
};
[[nodiscard]] ElectricalRange output_range(const RigDraft& draft);
[[nodiscard]] ElectricalRange input_range(const RigDraft& draft);
[[nodiscard]] drivers::ElectricalUnit output_unit(const RigDraft& draft) noexcept;
[[nodiscard]] drivers::ElectricalUnit input_unit(const RigDraft& draft) noexcept;
/// All modules vent by themselves when nobody talks to them. A simulated board does.
[[nodiscard]] bool has_watchdog(const RigDraft& draft) noexcept;

/// The text of a rig file at `path`, with comments, that the rig file's reader accepts; or what it says
/// against it. Paths in it are relative to the file's folder where they lie below it.
[[nodiscard]] tl::expected<std::string, document::Problems> draft_text(const RigDraft& draft,
                                                                       const std::string& path);

}  // namespace softgrip::tools
