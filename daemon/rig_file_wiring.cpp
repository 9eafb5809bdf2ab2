// How a channel of a rig file is wired: valve, sensor, pressure monitor.

#include <algorithm>
#include <cmath>

#include "daemon/rig_file_reader.h"
#include "model/document/number.h"

namespace softgrip::daemon::rig_file {

namespace {

using document::Node;
using document::written;
using drivers::ElectricalUnit;

/// V and mA of any board there is; tighter limits come from the board map.
constexpr document::Range electrical{-100, 100};

/// Which of `stem_v` and `stem_ma` stands in the map decides the unit.
struct ElectricalKey {
  std::string name;
  ElectricalUnit unit = ElectricalUnit::volt;
};

ElectricalKey electrical_key(MapReader& reader, const std::string& stem) {
  const bool ma = reader.has(stem + "_ma");
  if (ma && reader.has(stem + "_v")) {
    reader.report(stem + "_ma", "`" + stem + "_v` and `" + stem + "_ma` exclude each other");
  }
  if (ma && !reader.has(stem + "_v")) return {stem + "_ma", ElectricalUnit::milliampere};
  if (ma) reader.optional_numbers(stem + "_ma", 2, electrical);
  return {stem + "_v", ElectricalUnit::volt};
}

/// `at_v: [0, 10], is_kpa: [0, 100]`
drivers::TwoPoints read_scaling(MapReader& reader, const std::string& at_key, std::string_view is_key,
                                document::Range is_range) {
  const auto at = reader.numbers(at_key, 2, electrical);
  const auto is = reader.numbers(is_key, 2, is_range);
  const auto distinct = [&](std::string_view key, const std::vector<double>& pair) {
    if (reader.good(key) && pair[0] == pair[1]) {
      reader.report(key, "the two points of `" + std::string(key) + "` must differ",
                    "a straight line goes through two points");
      return false;
    }
    return true;
  };
  const bool at_good = distinct(at_key, at);
  const bool is_good = distinct(is_key, is);
  if (!at_good || !is_good || !reader.good(at_key) || !reader.good(is_key)) return {};
  return {at[0], is[0], at[1], is[1]};
}

/// A terminal of the board, used once, there, and of the right unit.
std::size_t read_terminal(Context& context, MapReader& reader, std::string_view key,
                          std::map<std::size_t, document::Location>& used) {
  const auto terminal = static_cast<std::size_t>(reader.integer(key, 0, 255));
  if (!reader.good(key)) return terminal;
  const auto [first, fresh] = used.try_emplace(terminal, reader.where(key));
  if (!fresh) {
    report_repeated(reader, key, "the " + std::string(key) + " " + std::to_string(terminal), first->second);
  }
  if (context.map) {
    const drivers::TerminalBlock& block = key == "output" ? context.map->outputs : context.map->inputs;
    if (terminal >= block.registers.count) {
      reader.report(key, "the board has no " + std::string(key) + " " + std::to_string(terminal),
                    "they count from 0 to " + std::to_string(block.registers.count - 1));
    }
  }
  return terminal;
}

void check_unit(Context& context, MapReader& reader, const ElectricalKey& key,
                const drivers::TerminalBlock& block) {
  if (!context.map || !reader.has(key.name) || block.unit == key.unit) return;
  reader.report(key.name, "the board's terminals are in " + std::string(drivers::name_of(block.unit)) +
                              " but `" + key.name + "` is in " + std::string(drivers::name_of(key.unit)));
}

/// What of the electrical range counts as a reading.
void read_validity(MapReader& reader, const std::string& valid_key, drivers::InputWiring& wiring) {
  const auto valid = reader.numbers(valid_key, 2, electrical);
  if (reader.good(valid_key) && valid[0] >= valid[1]) {
    reader.report(valid_key, "the first number of `" + valid_key + "` must be the smaller one");
  }
  wiring.valid_min = valid[0];
  wiring.valid_max = valid[1];
}

/// `error_codes: [{at_ma: 3.75, tolerance_ma: 0.05}]`
void read_error_codes(Context& context, MapReader& reader, const std::string& who,
                      drivers::InputWiring& wiring) {
  const std::string suffix = wiring.unit == ElectricalUnit::volt ? "_v" : "_ma";
  for (const Node* item : reader.sequence("error_codes", false)) {
    MapReader code(context.document, *item, context.problems, "an error code of the " + who);
    const double at = code.number("at" + suffix, electrical);
    const double tolerance = code.number("tolerance" + suffix, {0, 100});
    wiring.error_codes.push_back({at, tolerance});
  }
}

drivers::InputWiring read_input(Context& context, MapReader& reader, const std::string& who,
                                std::string_view is_key, document::Range is_range) {
  drivers::InputWiring wiring;
  wiring.input = read_terminal(context, reader, "input", context.inputs);
  const ElectricalKey at = electrical_key(reader, "at");
  wiring.unit = at.unit;
  wiring.scaling = read_scaling(reader, at.name, is_key, is_range);
  if (context.map) check_unit(context, reader, at, context.map->inputs);
  read_validity(reader, at.unit == ElectricalUnit::volt ? "valid_v" : "valid_ma", wiring);
  read_error_codes(context, reader, who, wiring);
  return wiring;
}

/// Whether the limits can be commanded and what they use of the valve.
void check_valve(Context& context, MapReader& reader, const ElectricalKey& at,
                 const drivers::OutputWiring& wiring, const control::LimitSettings& limits,
                 const ValveFacts& facts) {
  const std::string range = written(facts.range_min_kpa) + " to " + written(facts.range_max_kpa) + " kPa";
  const std::string used =
      written(limits.pressure_min_kpa) + " to " + written(limits.pressure_max_kpa) + " kPa";
  if (limits.pressure_min_kpa < facts.range_min_kpa || limits.pressure_max_kpa > facts.range_max_kpa) {
    reader.report("range_kpa", "the limits allow " + used + ", the valve controls " + range,
                  "narrow pressure_min_kpa and pressure_max_kpa");
    return;
  }
  const double share =
      (limits.pressure_max_kpa - limits.pressure_min_kpa) / (facts.range_max_kpa - facts.range_min_kpa);
  if (share < 0.2) {
    reader.warn("range_kpa",
                "the limits use less than a fifth of the valve's range (" + used + " of " + range +
                    "): resolution and linearity suffer",
                "a valve with a smaller range resolves the finger better");
  }
  if (!context.map) return;
  const drivers::TerminalBlock& block = context.map->outputs;
  const double a = block.scaling.y_at(block.raw_min);
  const double b = block.scaling.y_at(block.raw_max);
  // Full scale is often one count beyond the largest raw number.
  const double slack = std::abs(b - a) * 1e-3;
  for (const double pressure : {limits.pressure_min_kpa, limits.pressure_max_kpa}) {
    const double needed = wiring.scaling.x_at(pressure);
    if (needed >= std::min(a, b) - slack && needed <= std::max(a, b) + slack) continue;
    const std::string unit(drivers::name_of(block.unit));
    reader.report(at.name,
                  written(pressure) + " kPa needs " + written(needed) + " " + unit +
                      ", the board's outputs go from " + written(std::min(a, b)) + " to " +
                      written(std::max(a, b)) + " " + unit,
                  "check the two points, or narrow the limits");
  }
}

void check_sensor(MapReader& reader, const drivers::InputWiring& wiring,
                  const control::LimitSettings& limits) {
  const double a = wiring.scaling.y_at(wiring.valid_min);
  const double b = wiring.scaling.y_at(wiring.valid_max);
  if (limits.displacement_min_mm >= std::min(a, b) && limits.displacement_max_mm <= std::max(a, b)) return;
  reader.warn(reader.has("valid_v") ? "valid_v" : "valid_ma",
              "the limits allow " + written(limits.displacement_min_mm) + " to " +
                  written(limits.displacement_max_mm) + " mm, the valid range of the sensor is " +
                  written(std::min(a, b)) + " to " + written(std::max(a, b)) + " mm",
              "beyond it a reading is invalid, which becomes a fault");
}

}  // namespace

drivers::OutputWiring read_valve(Context& context, const Node& node, const std::string& who,
                                 const control::LimitSettings& limits, ValveFacts& facts) {
  const std::size_t before = context.problems.size();
  MapReader reader(context.document, node, context.problems, "the valve of " + who);
  drivers::OutputWiring wiring;
  wiring.output = read_terminal(context, reader, "output", context.outputs);
  const ElectricalKey at = electrical_key(reader, "at");
  wiring.unit = at.unit;
  wiring.scaling = read_scaling(reader, at.name, "is_kpa", {-200, 10'000});
  if (context.map) check_unit(context, reader, at, context.map->outputs);
  const auto range = reader.numbers("range_kpa", 2, {-200, 10'000});
  facts.range_min_kpa = range[0];
  facts.range_max_kpa = range[1];
  if (reader.good("range_kpa") && range[0] >= range[1]) {
    reader.report("range_kpa", "the first number of `range_kpa` must be the smaller one");
  }
  facts.on_power_loss = static_cast<PowerLoss>(reader.choice("on_power_loss", {"vents", "holds"}));
  reader.finish();
  const bool limits_known = limits.pressure_max_kpa > limits.pressure_min_kpa;
  if (context.problems.size() == before && limits_known) {
    check_valve(context, reader, at, wiring, limits, facts);
  }
  return wiring;
}

drivers::InputWiring read_sensor(Context& context, const Node& node, const std::string& who,
                                 const control::LimitSettings& limits) {
  const std::size_t before = context.problems.size();
  MapReader reader(context.document, node, context.problems, "the sensor of " + who);
  drivers::InputWiring wiring = read_input(context, reader, "sensor of " + who, "is_mm", {-10'000, 10'000});
  reader.finish();
  const bool limits_known = limits.displacement_max_mm > limits.displacement_min_mm;
  if (context.problems.size() == before && limits_known) check_sensor(reader, wiring, limits);
  return wiring;
}

drivers::InputWiring read_pressure_monitor(Context& context, const Node& node, const std::string& who) {
  MapReader reader(context.document, node, context.problems, "the pressure monitor of " + who);
  return read_input(context, reader, "pressure monitor of " + who, "is_kpa", {-200, 10'000});
}

}  // namespace softgrip::daemon::rig_file
