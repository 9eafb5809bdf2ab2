// Reads a simulated board from a rig file.

#include <algorithm>
#include <array>

#include "base/random.h"
#include "rig/rig_file_reader.h"
#include "simulation/plant/plant.h"

namespace softgrip::rig {

namespace {

using document::Node;

/// Returns the seed of a channel. A step of SplitMix64 (Steele, Lea, Flood 2014) computes it from the seed of
/// the board and the index of the channel, so that channels have different seeds.
std::uint64_t seed_of(std::uint64_t seed, std::uint64_t channel) {
  return scattered(seed + channel * 0x9e3779b97f4a7c15U);
}

simulation::PlantSettings read_plant(Context& context, const Node& node, const std::string& name) {
  MapReader reader(context.document, node, context.problems, "the plant of `" + name + "`");
  simulation::PlantSettings plant;
  read_keys(reader, rig_keys().plant, plant);
  if (const auto model = named_model(context, reader, "model", InputFile::Role::plant)) plant.model = *model;
  if (const Node* object = reader.child("object", false))
    plant.object = simulation::read_object(context.document, *object, context.problems);
  plant.sample_time_s = context.period_s();
  return plant;
}

simulation::SimulatedChannel simulated_channel(const Context& context, std::size_t index) {
  const drivers::ChannelWiring& wiring = context.wiring[index];
  simulation::SimulatedChannel channel;
  channel.name = wiring.name;
  channel.measures_pressure = wiring.pressure.has_value();
  channel.measures_temperature = wiring.temperature.has_value();
  channel.valve_min_kpa = context.rig.valves[index].range_min_kpa;
  channel.valve_max_kpa = context.rig.valves[index].range_max_kpa;
  channel.vented_kpa = vented_kpa(context.rig.settings.channels[index].limits);
  const drivers::InputWiring& sensor = wiring.displacement;
  const double a = sensor.scaling.y_at(sensor.valid_min);
  const double b = sensor.scaling.y_at(sensor.valid_max);
  channel.sensor_min_mm = std::min(a, b);
  channel.sensor_max_mm = std::max(a, b);
  return channel;
}

using Event = simulation::SimulatedEvent;

void read_line_fault(MapReader& reader, Event& event) {
  event.kind = Event::Kind::line_fault;
  event.line.kind = reader.choice("line", simulation::line_fault_names);
  if (event.line.kind == simulation::LineFault::Kind::leaking)
    document::read_keys(reader, {simulation::leak_key()}, event.line);
}

void read_sensor_fault(MapReader& reader, Event& event) {
  event.kind = Event::Kind::sensor_fault;
  event.sensor.kind = reader.choice("sensor", simulation::sensor_fault_names);
  if (event.sensor.kind == simulation::SensorFault::Kind::offset)
    document::read_keys(reader, {simulation::offset_key("value_mm")}, event.sensor);
}

void read_object_event(Context& context, MapReader& reader, Event& event) {
  event.kind = Event::Kind::object;
  const Node* const node = reader.child("object", true);
  if (node == nullptr) return;
  if (node->kind == Node::Kind::scalar && node->scalar == "none") return;
  event.object = simulation::read_object(context.document, *node, context.problems);
}

/// The keys that determine the kind of an event. Each event must have exactly one of them.
constexpr std::array<std::string_view, 5> happenings{"object", "line", "sensor", "bus", "writes"};

Event read_event(Context& context, const Node& node) {
  MapReader reader(context.document, node, context.problems, "an event");
  Event event;
  event.at_s = reader.number("at_s", {0, 1e7});
  const auto count = std::count_if(happenings.begin(), happenings.end(),
                                   [&](std::string_view key) { return reader.has(key); });
  if (count != 1 && node.kind == Node::Kind::map) {
    context.problems.add(context.document.problem(
        node.at, "an event must have exactly one of `object`, `line`, `sensor`, `bus` and `writes`"));
  }
  if (reader.has("object")) read_object_event(context, reader, event);
  if (reader.has("line")) read_line_fault(reader, event);
  if (reader.has("sensor")) read_sensor_fault(reader, event);
  if (reader.has("bus")) {
    const std::size_t choice = reader.choice("bus", {"lost", "silent", "restored"});
    event.kind = choice == 2 ? Event::Kind::bus_restored : Event::Kind::bus_lost;
    event.status = choice == 1 ? drivers::BusStatus::timed_out : drivers::BusStatus::disconnected;
  }
  if (reader.has("writes")) {
    event.kind = reader.choice("writes", {"refused", "taken"}) == 0 ? Event::Kind::write_refused
                                                                    : Event::Kind::write_taken;
  }
  if (reader.has("channel")) {
    std::vector<std::string> names;
    for (const drivers::ChannelWiring& wiring : context.wiring) names.push_back(wiring.name);
    event.channel = reader.choice("channel", names);
  }
  return event;
}

}  // namespace

void read_simulated_board(Context& context, const Node& node) {
  MapReader reader(context.document, node, context.problems, "simulated");
  simulation::SimulatedBoardSettings settings;
  read_keys(reader, rig_keys().seed, context.rig);
  read_keys(reader, rig_keys().simulated, settings);
  simulation::SimulatedChannel converters;
  read_keys(reader, rig_keys().converters, converters);
  if (const Node* plants = reader.child("plants", true)) {
    MapReader plant_reader(context.document, *plants, context.problems, "plants");
    for (std::size_t i = 0; i < context.wiring.size(); ++i) {
      simulation::SimulatedChannel channel = simulated_channel(context, i);
      channel.output_bits = converters.output_bits;
      channel.input_bits = converters.input_bits;
      const Node* const plant = channel.name.empty() ? nullptr : plant_reader.child(channel.name, true);
      if (plant != nullptr) channel.plant = read_plant(context, *plant, channel.name);
      channel.plant.seed = seed_of(context.rig.seed.value_or(0), i);
      settings.channels.push_back(std::move(channel));
    }
  }
  for (const Node* event : reader.sequence("events", false)) {
    settings.events.push_back(read_event(context, *event));
  }
  context.rig.board = std::move(settings);
}

}  // namespace softgrip::rig

namespace softgrip::rig {

bool reseed(RigFile& rig, std::uint64_t seed) {
  auto* const board = std::get_if<simulation::SimulatedBoardSettings>(&rig.board);
  if (board == nullptr) return false;
  rig.seed = seed;
  for (std::size_t i = 0; i < board->channels.size(); ++i) {
    board->channels[i].plant.seed = seed_of(seed, i);
  }
  return true;
}

}  // namespace softgrip::rig
