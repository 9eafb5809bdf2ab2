#pragma once
// Emulates one finger: its simulation, and its wiring to the board.
// Provides a default wiring of fingers to an emulated board, for an emulator that is started without a rig
// file.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "drivers/board/board_map.h"
#include "drivers/board/channel_wiring.h"
#include "simulation/emulator/emulated_board.h"
#include "simulation/plant/plant.h"

namespace softgrip::simulation {

class Finger {
 public:
  Finger(drivers::ChannelWiring wiring, const simulation::PlantSettings& settings);

  [[nodiscard]] const std::string& name() const noexcept { return wiring_.name; }
  [[nodiscard]] const simulation::Plant& plant() const noexcept { return plant_; }

  /// Reads the signal at the output terminal of the finger and sets the commanded pressure of the simulation.
  /// `modules` contains the modules of the board, with the same indices as in the wiring.
  void take_command(std::span<const EmulatedBoard> modules);
  /// Advances the finger by `duration_s`. The command is constant during this time.
  void advance(double duration_s) noexcept { plant_.advance(duration_s); }
  /// Sets the inputs of the board to the signals of the finger's sensors.
  void show(std::span<EmulatedBoard> modules) const;

  /// Sets the faults of the finger. A fault that is already active is not restarted. Therefore, a stuck
  /// sensor keeps its value.
  void set_faults(const simulation::LineFault& line, const simulation::SensorFault& sensor);
  /// Places the object of the finger if `there` is true, otherwise removes the object.
  void place_object(bool there);
  [[nodiscard]] bool has_object() const noexcept { return plant_.object().has_value(); }
  /// Sets the object that place_object() places.
  void set_object(const std::optional<simulation::PlantObject>& object) noexcept { object_ = object; }

 private:
  drivers::ChannelWiring wiring_;
  simulation::Plant plant_;
  std::optional<simulation::PlantObject> object_;
  simulation::LineFault line_;
  simulation::SensorFault sensor_;
};

/// Returns the wiring of the channels left, right, finger_3, ... Valve i is on output i, and sensor i is on
/// input i. If the board has at least two inputs per finger, the last inputs are pressure monitors. The
/// terminals of all modules are numbered consecutively. The lower end of a terminal's range (0 V or 4 mA) is
/// 0 kPa and -5 mm. The upper end (10 V or 20 mA) is 100 kPa and 45 mm, as in config/rig_tcp.yaml. A terminal
/// with the unit kPa is a pressure generator or a pressure sensor, so it needs no scaling. The error is one
/// sentence.
[[nodiscard]] tl::expected<std::vector<drivers::ChannelWiring>, std::string> default_wiring(
    std::span<const drivers::BoardMap> modules, std::size_t channels);

}  // namespace softgrip::simulation
