#pragma once
// One emulated finger on the board: its plant, and the terminals it is wired to.

#include <optional>
#include <span>

#include "drivers/board/channel_wiring.h"
#include "simulation/emulator/emulated_board.h"
#include "simulation/plant/plant.h"

namespace softgrip::simulation {

class Finger {
 public:
  Finger(drivers::ChannelWiring wiring, const simulation::PlantSettings& settings);

  [[nodiscard]] const std::string& name() const noexcept { return wiring_.name; }
  [[nodiscard]] const simulation::Plant& plant() const noexcept { return plant_; }

  /// Takes the pressure that the output asks for. `modules` are those of the board, as the wiring counts
  /// them.
  void take_command(std::span<const EmulatedBoard> modules);
  /// Moves on by `duration_s` under the held command.
  void advance(double duration_s) noexcept { plant_.advance(duration_s); }
  /// Puts what the sensors show on the inputs.
  void show(std::span<EmulatedBoard> modules) const;

  /// Faults as they should be from now on; unchanged ones are left alone (a stuck sensor stays where it
  /// stuck).
  void set_faults(const simulation::LineFault& line, const simulation::SensorFault& sensor);
  /// Puts the object of the settings there, or takes it away.
  void place_object(bool there);
  [[nodiscard]] bool has_object() const noexcept { return plant_.object().has_value(); }
  /// What place_object() places.
  void set_object(const std::optional<simulation::PlantObject>& object) noexcept { object_ = object; }

 private:
  drivers::ChannelWiring wiring_;
  simulation::Plant plant_;
  std::optional<simulation::PlantObject> object_;
  simulation::LineFault line_;
  simulation::SensorFault sensor_;
};

}  // namespace softgrip::simulation
