#include "simulation/emulator/finger.h"

#include <utility>

namespace softgrip::simulation {

Finger::Finger(drivers::ChannelWiring wiring, const simulation::PlantSettings& settings)
    : wiring_(std::move(wiring)), plant_(settings), object_(settings.object) {}

void Finger::take_command(std::span<const EmulatedBoard> modules) {
  const drivers::OutputWiring& valve = wiring_.valve;
  plant_.command(valve.scaling.y_at(modules[valve.module].output(valve.output)));
}

void Finger::show(std::span<EmulatedBoard> modules) const {
  const drivers::InputWiring& sensor = wiring_.displacement;
  EmulatedBoard& board = modules[sensor.module];
  if (!plant_.sees_nothing()) {
    board.set_input(sensor.input, sensor.scaling.x_at(plant_.reading_mm()));
  } else if (!sensor.error_codes.empty()) {
    board.set_input(sensor.input, sensor.error_codes.front().electrical);
  } else {
    board.set_input_error(sensor.input);
  }
  if (wiring_.temperature) {
    modules[wiring_.temperature->module].set_input(
        wiring_.temperature->input, wiring_.temperature->scaling.x_at(plant_.measured_temperature_c()));
  }
  if (wiring_.pressure) {
    modules[wiring_.pressure->module].set_input(
        wiring_.pressure->input, wiring_.pressure->scaling.x_at(plant_.measured_pressure_kpa()));
  }
}

void Finger::set_faults(const simulation::LineFault& line, const simulation::SensorFault& sensor) {
  if (line.kind != line_.kind || line.share != line_.share) plant_.set_fault(line);
  if (sensor.kind != sensor_.kind || sensor.value_mm != sensor_.value_mm) plant_.set_fault(sensor);
  line_ = line;
  sensor_ = sensor;
}

void Finger::place_object(bool there) {
  const std::optional<simulation::PlantObject> wanted = there ? object_ : std::nullopt;
  if (wanted != plant_.object()) plant_.set_object(wanted);
}

}  // namespace softgrip::simulation
