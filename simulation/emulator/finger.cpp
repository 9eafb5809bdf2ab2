#include "simulation/emulator/finger.h"

#include <algorithm>
#include <utility>

namespace softgrip::simulation {
namespace {

constexpr double pressure_span_kpa = 100;
constexpr double nearest_mm = -5;
constexpr double farthest_mm = 45;

/// Lower and upper end of the usual signal range of a terminal. The converter of the terminal may have a
/// wider range.
struct Span {
  double low;
  double high;
};
Span span_of(const drivers::Terminal& terminal) {
  switch (terminal.unit) {
    case drivers::ElectricalUnit::volt:
      return {0, 10};
    case drivers::ElectricalUnit::milliampere:
      return {4, 20};
    case drivers::ElectricalUnit::kilopascal:
      break;
  }
  return {0, terminal.highest};
}

/// A terminal, and the index of the module to which the terminal belongs.
struct Place {
  std::size_t module;
  std::size_t index;
  drivers::Terminal terminal;
};

struct Places {
  std::vector<Place> outputs;
  std::vector<Place> signals;    // input terminals for displacement sensors
  std::vector<Place> pressures;  // input terminals in kPa, which measure pressure directly
};

Places places_of(std::span<const drivers::BoardMap> modules) {
  Places places;
  for (std::size_t module = 0; module < modules.size(); ++module) {
    const drivers::ModuleTerminals terminals = drivers::terminals_of(modules[module]);
    for (std::size_t i = 0; i < terminals.outputs.size(); ++i) {
      places.outputs.push_back({module, i, terminals.outputs[i]});
    }
    for (std::size_t i = 0; i < terminals.inputs.size(); ++i) {
      const bool pressure = terminals.inputs[i].unit == drivers::ElectricalUnit::kilopascal;
      (pressure ? places.pressures : places.signals).push_back({module, i, terminals.inputs[i]});
    }
  }
  return places;
}

std::string channel_name(std::size_t index) {
  if (index == 0) return "left";
  if (index == 1) return "right";
  return "finger_" + std::to_string(index + 1);
}

drivers::InputWiring input_at(const Place& place, double low, double high) {
  const Span span = span_of(place.terminal);
  drivers::InputWiring wiring;
  wiring.module = place.module;
  wiring.input = place.index;
  wiring.unit = place.terminal.unit;
  wiring.scaling = {span.low, low, span.high, high};
  wiring.valid_min = span.low;
  wiring.valid_max = span.high;
  return wiring;
}

drivers::OutputWiring output_at(const Place& place) {
  const Span span = span_of(place.terminal);
  drivers::OutputWiring wiring;
  wiring.module = place.module;
  wiring.output = place.index;
  wiring.unit = place.terminal.unit;
  const bool pressure = wiring.unit == drivers::ElectricalUnit::kilopascal;
  wiring.scaling = {span.low, 0, span.high, pressure ? span.high : pressure_span_kpa};
  return wiring;
}

/// Returns the wiring of a pressure monitor. The ends of the range of an input in V or mA represent the
/// pressures at the ends of the valve's range.
drivers::InputWiring monitor_at(const Place& place, const drivers::OutputWiring& valve) {
  if (place.terminal.unit != drivers::ElectricalUnit::kilopascal) {
    return input_at(place, valve.scaling.y0, valve.scaling.y1);
  }
  drivers::InputWiring wiring = input_at(place, 0, place.terminal.highest);
  wiring.valid_min = place.terminal.lowest;
  return wiring;
}

}  // namespace

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

tl::expected<std::vector<drivers::ChannelWiring>, std::string> default_wiring(
    std::span<const drivers::BoardMap> modules, std::size_t channels) {
  const Places places = places_of(modules);
  if (channels < 1 || channels > std::min(places.signals.size(), places.outputs.size())) {
    std::string names;
    for (const drivers::BoardMap& map : modules) names += (names.empty() ? "" : " and ") + map.name;
    return tl::unexpected{names + (modules.size() == 1 ? " has " : " have ") +
                          std::to_string(places.outputs.size()) + " outputs and " +
                          std::to_string(places.signals.size()) +
                          " inputs for sensors: " + (modules.size() == 1 ? "it" : "they") + " cannot serve " +
                          std::to_string(channels) + " channels"};
  }
  std::vector<drivers::ChannelWiring> wiring(channels);
  for (std::size_t i = 0; i < channels; ++i) {
    wiring[i].name = channel_name(i);
    wiring[i].valve = output_at(places.outputs[i]);
    wiring[i].displacement = input_at(places.signals[i], nearest_mm, farthest_mm);
    if (places.pressures.size() >= channels) {
      wiring[i].pressure = monitor_at(places.pressures[i], wiring[i].valve);
    } else if (2 * channels <= places.signals.size()) {
      wiring[i].pressure = monitor_at(places.signals[places.signals.size() - channels + i], wiring[i].valve);
    }
  }
  return wiring;
}

}  // namespace softgrip::simulation
