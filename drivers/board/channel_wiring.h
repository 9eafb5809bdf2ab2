#pragma once
// How one finger is wired to a board: which terminals of which module, and what their volts or milliamperes
// mean. The rig file says it; the board scales by it.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drivers/board/board_map.h"
#include "drivers/board/two_points.h"

namespace softgrip::drivers {

/// An electrical value by which a sensor says that it cannot measure (Keyence IL: 5.5 V or 3.00 mA,
/// optoNCDT 1402: 3.75 mA).
struct SensorErrorCode {
  double electrical = 0;  ///< V or mA, as the input
  double tolerance = 0;   ///< of the same unit, at least 0
};

/// A sensor on an input of the board.
struct InputWiring {
  std::size_t input = 0;                       ///< terminal, from 0
  ElectricalUnit unit = ElectricalUnit::volt;  ///< as the rig file states it; must be the board's
  TwoPoints scaling;                           ///< x: V or mA, y: mm, kPa or degrees Celsius; slope sign free
  double valid_min = 0;  ///< electrical range in which a reading is valid, both ends included
  double valid_max = 0;
  std::vector<SensorErrorCode> error_codes;
  std::size_t module = 0;  ///< of a board that has several
};

/// A valve on an output of the board.
struct OutputWiring {
  std::size_t output = 0;  ///< terminal, from 0
  ElectricalUnit unit = ElectricalUnit::volt;
  TwoPoints scaling;       ///< x: V or mA, y: kPa
  std::size_t module = 0;  ///< of a board that has several
};

/// One channel: one valve, one displacement sensor, perhaps the valve's pressure monitor and a temperature
/// sensor, which several channels may share.
struct ChannelWiring {
  std::string name;
  OutputWiring valve;
  InputWiring displacement;
  std::optional<InputWiring> pressure;
  std::optional<InputWiring> temperature{};
};

/// One terminal that can be wired to.
struct Terminal {
  ElectricalUnit unit = ElectricalUnit::volt;
  double lowest = 0;  ///< what an output can deliver; of an input without meaning
  double highest = 0;
};

/// What one module of a board offers.
struct ModuleTerminals {
  std::string name;  ///< in messages
  std::vector<Terminal> inputs;
  std::vector<Terminal> outputs;
};
[[nodiscard]] ModuleTerminals terminals_of(const BoardMap& map);

/// What does not fit together, one sentence each; empty: the board can be made. Checks terminals against what
/// the modules have and their units, terminals used twice (but by temperature sensors alone), modules without
/// a wire, two equal scaling points, empty validity ranges.
[[nodiscard]] std::vector<std::string> wiring_problems(std::span<const ModuleTerminals> modules,
                                                       std::span<const ChannelWiring> wiring);
/// The same for a board of one module.
[[nodiscard]] std::vector<std::string> wiring_problems(const BoardMap& map,
                                                       std::span<const ChannelWiring> wiring);

}  // namespace softgrip::drivers
