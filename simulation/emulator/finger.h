#pragma once
// One emulated finger: its plant and its wiring to the board.

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

  /// Sets the commanded pressure from the signal at the output terminal. `modules` contains the modules of
  /// the board, indexed as in the wiring.
  void take_command(std::span<const EmulatedBoard> modules);
  /// Advances by `duration_s` with a constant command.
  void advance(double duration_s) noexcept { plant_.advance(duration_s); }
  /// Sets the inputs of the board to the sensor signals.
  void show(std::span<EmulatedBoard> modules) const;

  /// Sets the faults. A fault that has not changed does not begin again, so that a stuck sensor keeps its
  /// value.
  void set_faults(const simulation::LineFault& line, const simulation::SensorFault& sensor);
  /// Places the object of the finger if `there` is true, and removes it otherwise.
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

}  // namespace softgrip::simulation
