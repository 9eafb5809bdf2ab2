#pragma once
// Defines the wiring of one finger to a board, as the rig file gives this wiring: module, terminals and
// scaling.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drivers/board/board_map.h"

namespace softgrip::drivers {

/// An electrical value by which a sensor reports that it cannot measure (Keyence IL: 5.5 V or 3.00 mA;
/// optoNCDT 1402: 3.75 mA).
struct SensorErrorCode {
  double electrical = 0;  ///< electrical value in the unit of the input (V or mA)
  double tolerance = 0;   ///< >= 0; largest difference between a measured value and `electrical`, in the same
                          ///< unit as `electrical`
};

/// A sensor on an input of the board.
struct InputWiring {
  std::size_t input = 0;                       ///< number of the input terminal; the first terminal has the
                                               ///< number 0
  ElectricalUnit unit = ElectricalUnit::volt;  ///< unit in the rig file; it must equal the unit of the
                                               ///< board's terminal
  TwoPoints scaling;                           ///< line from the electrical value in V or mA (x) to mm, kPa
                                               ///< or degrees C (y); the slope may be positive or negative
  double valid_min = 0;  ///< lower end of the range in which a reading is valid, in V or mA; a reading at an
                         ///< end of the range is valid
  double valid_max = 0;
  std::vector<SensorErrorCode> error_codes;
  std::size_t module = 0;  ///< index of the module, for a board with several modules
};

/// A valve on an output of the board.
struct OutputWiring {
  std::size_t output = 0;  ///< number of the output terminal; the first terminal has the number 0
  ElectricalUnit unit = ElectricalUnit::volt;
  TwoPoints scaling;       ///< line from the electrical value in V or mA (x) to the pressure in kPa (y)
  std::size_t module = 0;  ///< index of the module, for a board with several modules
};

/// One channel: a valve and a displacement sensor. A pressure monitor of the valve and a temperature sensor
/// are optional. Several channels may share one temperature sensor.
struct ChannelWiring {
  std::string name;
  OutputWiring valve;
  InputWiring displacement;
  std::optional<InputWiring> pressure;
  std::optional<InputWiring> temperature{};
};

/// One terminal of a module.
struct Terminal {
  ElectricalUnit unit = ElectricalUnit::volt;
  double lowest = 0;  ///< lower end of the range of an output; not used for an input
  double highest = 0;
};

/// The terminals of one module of a board.
struct ModuleTerminals {
  std::string name;  ///< name of the module in messages
  std::vector<Terminal> inputs;
  std::vector<Terminal> outputs;
};
[[nodiscard]] ModuleTerminals terminals_of(const BoardMap& map);

/// Returns the errors of the wiring, one sentence each. The result is empty if the board can be created. Each
/// terminal must exist and have the unit that the wiring states. Only temperature sensors may share a
/// terminal. A channel must use each module. The two points of a scaling must differ. The lower end of a
/// validity range must be below its upper end.
[[nodiscard]] std::vector<std::string> wiring_problems(std::span<const ModuleTerminals> modules,
                                                       std::span<const ChannelWiring> wiring);
/// Returns the errors of the wiring for a board that has only one module.
[[nodiscard]] std::vector<std::string> wiring_problems(const BoardMap& map,
                                                       std::span<const ChannelWiring> wiring);

}  // namespace softgrip::drivers
