#pragma once
// Creates the rig-file template of `softgrip init` from a few facts.

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

/// A module of the board: its board map and its position.
struct DraftModule {
  std::string path;
  drivers::BoardMap map;
};

/// The facts of the rig. Terminals are numbered in order: valve i on output i, sensor i on input i, the
/// monitors on the last inputs.
struct RigDraft {
  std::string name = "my_rig";
  std::optional<double> rate_hz;     ///< nullopt: the highest usual rate that the rig-file reader accepts
  std::vector<DraftModule> modules;  ///< empty: a board simulated in the process
  std::string host;                  ///< numeric address of a network board; empty: on a serial line
  int port = 502;
  std::string device;  ///< path of the serial device
  int baud = 9600;
  int unit = 1;  ///< unit id of the first module; the others follow in order
  std::vector<std::string> fingers{"left", "right"};
  std::string model_path;
  model::Model model;
  drivers::TwoPoints valve{0, 0, 10, 100};   ///< x: electrical value at the terminal, y: kPa
  drivers::TwoPoints sensor{0, -5, 10, 45};  ///< x: electrical value at the terminal, y: mm
  double pressure_max_kpa = 60;
  bool monitor = true;  ///< each finger has a pressure monitor, with the same line as the valve
  bool accepts_no_watchdog = false;
  std::string sequences_path;
  bool service = false;  ///< use the folders of the system service
};

/// Returns the module whose outputs (or inputs) are used, or null if no module has any or the board is
/// simulated.
[[nodiscard]] const DraftModule* output_module(const RigDraft& draft) noexcept;
[[nodiscard]] const DraftModule* input_module(const RigDraft& draft) noexcept;
/// Returns the largest number of fingers for which the board has enough terminals, with or without pressure
/// monitors.
[[nodiscard]] std::size_t most_fingers(const RigDraft& draft, bool monitor) noexcept;
/// Range of the signal of a valve or sensor at a terminal. It is the usual range, 0 to 10 V or 4 to 20 mA.
/// For a terminal in kilopascals, it is the range that the terminal can deliver.
struct ElectricalRange {
  double lowest = 0;
  double highest = 10;
};
[[nodiscard]] ElectricalRange output_range(const RigDraft& draft);
[[nodiscard]] ElectricalRange input_range(const RigDraft& draft);
[[nodiscard]] drivers::ElectricalUnit output_unit(const RigDraft& draft) noexcept;
[[nodiscard]] drivers::ElectricalUnit input_unit(const RigDraft& draft) noexcept;
/// Returns true if every module vents when communication stops. This is true for a simulated board.
[[nodiscard]] bool has_watchdog(const RigDraft& draft) noexcept;

/// Returns the text of a commented rig file for `path` that the rig-file reader accepts, or the problems that
/// the reader reports. Paths below the file's folder are written relative to it.
[[nodiscard]] tl::expected<std::string, document::Problems> draft_text(const RigDraft& draft,
                                                                       const std::string& path);

}  // namespace softgrip::tools
