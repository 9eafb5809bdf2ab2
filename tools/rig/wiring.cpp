#include "tools/rig/wiring.h"

#include <algorithm>
#include <string>

namespace softgrip::tools::rig {
namespace {

constexpr double pressure_span_kpa = 100;
constexpr double nearest_mm = -5;
constexpr double farthest_mm = 45;

/// Both ends of the usual signal, whatever the converter can do beyond.
struct Span {
  double low;
  double high;
};
Span span_of(drivers::ElectricalUnit unit) {
  return unit == drivers::ElectricalUnit::volt ? Span{0, 10} : Span{4, 20};
}

std::string channel_name(std::size_t index) {
  if (index == 0) return "left";
  if (index == 1) return "right";
  return "finger_" + std::to_string(index + 1);
}

drivers::InputWiring input_at(const drivers::BoardMap& map, std::size_t terminal, double low, double high) {
  const Span span = span_of(map.inputs.unit);
  drivers::InputWiring wiring;
  wiring.input = terminal;
  wiring.unit = map.inputs.unit;
  wiring.scaling = {span.low, low, span.high, high};
  wiring.valid_min = span.low;
  wiring.valid_max = span.high;
  return wiring;
}

}  // namespace

tl::expected<std::vector<drivers::ChannelWiring>, std::string> default_wiring(const drivers::BoardMap& map,
                                                                              std::size_t channels) {
  const std::size_t inputs = map.inputs.registers.count;
  const std::size_t outputs = map.outputs.registers.count;
  if (channels < 1 || channels > std::min(inputs, outputs)) {
    return tl::unexpected{map.name + " has " + std::to_string(outputs) + " outputs and " +
                          std::to_string(inputs) + " inputs: it cannot serve " + std::to_string(channels) +
                          " channels"};
  }
  std::vector<drivers::ChannelWiring> wiring(channels);
  const Span span = span_of(map.outputs.unit);
  for (std::size_t i = 0; i < channels; ++i) {
    wiring[i].name = channel_name(i);
    wiring[i].valve = {i, map.outputs.unit, {span.low, 0, span.high, pressure_span_kpa}};
    wiring[i].displacement = input_at(map, i, nearest_mm, farthest_mm);
    if (2 * channels <= inputs) {
      wiring[i].pressure = input_at(map, inputs - channels + i, 0, pressure_span_kpa);
    }
  }
  return wiring;
}

}  // namespace softgrip::tools::rig
