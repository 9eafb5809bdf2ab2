// Reads the wiring of a channel from a rig file: valve, displacement sensor, pressure monitor and temperature
// sensor.

#include <algorithm>
#include <cmath>

#include "base/numbers.h"
#include "document/node.h"
#include "rig/board_map_file.h"
#include "rig/rig_file_reader.h"

namespace softgrip::rig {

namespace {

using document::Node;
using drivers::ElectricalUnit;

/// Returns the range of values in V, mA or kPa that a rig file may contain for a terminal of any supported
/// board. The limits of a particular board map are narrower than this range.
constexpr document::Range range_of(ElectricalUnit unit) {
  return unit == ElectricalUnit::kilopascal ? line_pressure_kpa : document::Range{-100, 100};
}

/// A key whose suffix gives the unit of its value, such as `at_v` or `at_ma`.
struct ElectricalKey {
  std::string name;
  ElectricalUnit unit = ElectricalUnit::volt;
};

ElectricalKey electrical_key(MapReader& reader, const std::string& stem) {
  std::optional<ElectricalKey> found;
  for (const auto& [suffix, unit] : electrical_suffixes) {
    const std::string name = stem + std::string(suffix);
    if (!reader.has(name)) continue;
    if (!found) {
      found = ElectricalKey{name, unit};
      continue;
    }
    reader.report(name, "`" + found->name + "` and `" + name + "` exclude each other");
    reader.optional_numbers(name, 2, range_of(unit));
  }
  return found.value_or(ElectricalKey{stem + "_v", ElectricalUnit::volt});
}

/// Reads the two points of a scaling, for example `at_v: [0, 10], is_kpa: [0, 100]`.
drivers::TwoPoints read_scaling(MapReader& reader, const ElectricalKey& at_key, std::string_view is_key,
                                document::Range is_range) {
  const auto at = reader.numbers(at_key.name, 2, range_of(at_key.unit));
  const auto is = reader.numbers(is_key, 2, is_range);
  const auto distinct = [&](std::string_view key, const std::vector<double>& pair) {
    if (reader.good(key) && pair[0] == pair[1]) {
      reader.report(key, "the two values of `" + std::string(key) + "` must differ",
                    "the scaling is a straight line through two different points");
      return false;
    }
    return true;
  };
  const bool at_good = distinct(at_key.name, at);
  const bool is_good = distinct(is_key, is);
  if (!at_good || !is_good || !reader.good(at_key.name) || !reader.good(is_key)) return {};
  return {at[0], is[0], at[1], is[1]};
}

/// Returns the index of the module that contains a terminal. If the key `module` is present, its value is the
/// name of the module. Otherwise, the module is the only one that has terminals of this direction.
std::size_t read_module(const Context& context, MapReader& reader, std::string_view key) {
  if (context.modules.size() <= 1) return 0;
  std::vector<std::string> names;
  std::vector<std::size_t> candidates;
  for (std::size_t i = 0; i < context.modules.size(); ++i) {
    const KnownModule& module = context.modules[i];
    names.push_back(module.name);
    if (!module.terminals) continue;
    const auto& terminals = key == "output" ? module.terminals->outputs : module.terminals->inputs;
    if (!terminals.empty()) candidates.push_back(i);
  }
  if (candidates.size() == 1 && !reader.has("module")) return candidates.front();
  const std::size_t chosen = reader.choice("module", names);
  return reader.good("module") ? chosen : context.modules.size();
}

/// Returns a terminal of a module; null if the module could not be read, or if the module has no such
/// terminal.
const drivers::Terminal* terminal_of(const Context& context, std::string_view key, std::size_t module,
                                     std::size_t index) {
  if (module >= context.modules.size() || !context.modules[module].terminals) return nullptr;
  const drivers::ModuleTerminals& known = *context.modules[module].terminals;
  const auto& terminals = key == "output" ? known.outputs : known.inputs;
  return index < terminals.size() ? &terminals[index] : nullptr;
}

/// Reads the number of a terminal. The terminal must exist, and only one channel may use it.
/// @param shared  terminals that several channels may use; null: there are none.
std::size_t read_terminal(Context& context, MapReader& reader, std::string_view key, std::size_t module,
                          UsedTerminals& used, UsedTerminals* shared = nullptr) {
  const auto terminal = static_cast<std::size_t>(reader.integer(key, {0, 255}));
  const bool unknown_module = !context.modules.empty() && module >= context.modules.size();
  if (!reader.good(key) || unknown_module) return terminal;
  const auto [first, fresh] = used.try_emplace({module, terminal}, reader.where(key));
  const bool again = shared != nullptr && !shared->try_emplace({module, terminal}, reader.where(key)).second;
  if (!fresh && !again) {
    report_repeated(reader, key, "the " + std::string(key) + " " + std::to_string(terminal), first->second);
  }
  const bool known = module < context.modules.size() && context.modules[module].terminals.has_value();
  if (!known || terminal_of(context, key, module, terminal) != nullptr) return terminal;
  const drivers::ModuleTerminals& there = *context.modules[module].terminals;
  const std::size_t count = key == "output" ? there.outputs.size() : there.inputs.size();
  const std::string who = context.modules.size() > 1 ? "the module `" + there.name + "`" : "the board";
  reader.report(key, who + " has no " + std::string(key) + " " + std::to_string(terminal),
                count == 0 ? "this module or board has no terminals of this kind"
                           : "these terminals have the numbers 0 to " + std::to_string(count - 1));
  return terminal;
}

void check_unit(MapReader& reader, const ElectricalKey& key, const drivers::Terminal* terminal) {
  if (terminal == nullptr || !reader.has(key.name) || terminal->unit == key.unit) return;
  reader.report(key.name, "the terminal of the board is in " + std::string(drivers::name_of(terminal->unit)) +
                              " but `" + key.name + "` is in " + std::string(drivers::name_of(key.unit)));
}

/// Reads the range of electrical values in which a reading is valid.
void read_validity(MapReader& reader, const std::string& valid_key, drivers::InputWiring& wiring) {
  const auto valid = reader.numbers(valid_key, 2, range_of(wiring.unit));
  if (reader.good(valid_key) && valid[0] >= valid[1]) {
    reader.report(valid_key, "the first number of `" + valid_key + "` must be smaller than the second");
  }
  wiring.valid_min = valid[0];
  wiring.valid_max = valid[1];
}

/// Reads the error codes of a sensor, for example `error_codes: [{at_ma: 3.75, tolerance_ma: 0.05}]`.
void read_error_codes(Context& context, MapReader& reader, const std::string& who,
                      drivers::InputWiring& wiring) {
  const std::string suffix(suffix_of(wiring.unit));
  for (const Node* item : reader.sequence("error_codes", false)) {
    MapReader code(context.document, *item, context.problems, "an error code of the " + who);
    const double at = code.number("at" + suffix, range_of(wiring.unit));
    const double tolerance = code.number("tolerance" + suffix, {0, 100});
    wiring.error_codes.push_back({at, tolerance});
  }
}

drivers::InputWiring read_input(Context& context, MapReader& reader, const std::string& who,
                                std::string_view is_key, document::Range is_range,
                                UsedTerminals* shared = nullptr) {
  drivers::InputWiring wiring;
  wiring.module = read_module(context, reader, "input");
  wiring.input = read_terminal(context, reader, "input", wiring.module, context.inputs, shared);
  const ElectricalKey at = electrical_key(reader, "at");
  wiring.unit = at.unit;
  wiring.scaling = read_scaling(reader, at, is_key, is_range);
  check_unit(reader, at, terminal_of(context, "input", wiring.module, wiring.input));
  read_validity(reader, "valid" + std::string(suffix_of(at.unit)), wiring);
  read_error_codes(context, reader, who, wiring);
  return wiring;
}

/// Returns true if the map contains all these keys without an error. An error in `channel_defaults` is
/// reported for the first channel only. For the next channels, this function detects the error.
bool all_good(const MapReader& reader, const std::vector<std::string>& keys) {
  return std::all_of(keys.begin(), keys.end(), [&](const std::string& key) { return reader.good(key); });
}

/// Checks that the pressure limits are within the ranges of the valve and of the board's output, and that
/// they use at least 20 % of the valve's range.
void check_valve(Context& context, MapReader& reader, const ElectricalKey& at,
                 const drivers::OutputWiring& wiring, const control::LimitSettings& limits,
                 const ValveFacts& facts) {
  const std::string range = written(facts.range_min_kpa) + " to " + written(facts.range_max_kpa) + " kPa";
  const std::string used =
      written(limits.pressure_min_kpa) + " to " + written(limits.pressure_max_kpa) + " kPa";
  if (limits.pressure_min_kpa < facts.range_min_kpa || limits.pressure_max_kpa > facts.range_max_kpa) {
    reader.report("range_kpa", "the limits allow " + used + ", but the valve controls only " + range,
                  "narrow pressure_min_kpa and pressure_max_kpa");
    return;
  }
  const double share =
      (limits.pressure_max_kpa - limits.pressure_min_kpa) / (facts.range_max_kpa - facts.range_min_kpa);
  if (share < 0.2) {
    reader.warn("range_kpa",
                "the pressure limits use less than 1/5 of the range of the valve (" + used + " of " + range +
                    "), which reduces the resolution and the linearity of the pressure",
                "a valve with a smaller range would control the pressure more precisely");
  }
  const drivers::Terminal* const terminal = terminal_of(context, "output", wiring.module, wiring.output);
  if (terminal == nullptr) return;
  // The comparison needs a tolerance of at least one raw number: on many boards, the nominal full scale
  // corresponds to the largest raw number plus 1. The tolerance of 0.1 % of the range covers one raw number
  // of a converter with 10 or more bits.
  const double slack = (terminal->highest - terminal->lowest) * 1e-3;
  for (const double pressure : {limits.pressure_min_kpa, limits.pressure_max_kpa}) {
    const double needed = wiring.scaling.x_at(pressure);
    if (needed >= terminal->lowest - slack && needed <= terminal->highest + slack) continue;
    const std::string unit(drivers::name_of(terminal->unit));
    reader.report(at.name,
                  written(pressure) + " kPa needs " + written(needed) + " " + unit +
                      ", but the outputs of the board have a range from " + written(terminal->lowest) +
                      " to " + written(terminal->highest) + " " + unit,
                  "check the two points of the scaling, or narrow the pressure limits");
  }
}

/// Warns if the valve does not go to the rest pressure when its power fails. Software cannot prevent this,
/// because the valve alone determines the pressure of its finger when it has no power.
void check_power_loss(MapReader& reader, const std::string& who, const control::LimitSettings& limits,
                      bool rest_stated, const ValveFacts& facts) {
  const bool holds = facts.on_power_loss == PowerLoss::holds;
  if (holds ? !rest_stated : is_rest(limits, facts.power_loss_kpa)) return;
  reader.warn(
      reader.has("on_power_loss_kpa") ? "on_power_loss_kpa" : "on_power_loss",
      "if the power fails, the valve of " + who +
          (holds ? " holds its last pressure" : " goes to " + written(facts.power_loss_kpa) + " kPa") +
          ", but the rest pressure is " + written(control::resting_kpa(limits)) + " kPa",
      "choose a valve that goes to the rest pressure without power, or change `rest_kpa`");
}

void check_sensor(MapReader& reader, const drivers::InputWiring& wiring,
                  const control::LimitSettings& limits) {
  const double a = wiring.scaling.y_at(wiring.valid_min);
  const double b = wiring.scaling.y_at(wiring.valid_max);
  if (limits.displacement_min_mm >= std::min(a, b) && limits.displacement_max_mm <= std::max(a, b)) return;
  reader.warn("valid" + std::string(suffix_of(wiring.unit)),
              "the limits allow " + written(limits.displacement_min_mm) + " to " +
                  written(limits.displacement_max_mm) + " mm, but the valid range of the sensor is " +
                  written(std::min(a, b)) + " to " + written(std::max(a, b)) + " mm",
              "a reading outside the range of the sensor is invalid and causes a fault");
}

}  // namespace

double vented_kpa(const control::LimitSettings& limits) {
  const double rest_kpa = control::resting_kpa(limits);
  return control::in_range(limits, 0) == rest_kpa ? 0 : rest_kpa;
}

bool is_rest(const control::LimitSettings& limits, double pressure_kpa) {
  const double slack_kpa = 0.01 * (limits.pressure_max_kpa - limits.pressure_min_kpa);
  const double inside_kpa =
      control::no_further(control::resting_kpa(limits), pressure_kpa, vented_kpa(limits));
  return std::abs(pressure_kpa - inside_kpa) <= slack_kpa;
}

drivers::OutputWiring read_valve(Context& context, const Node& node, const std::string& who,
                                 const control::LimitSettings& limits, bool rest_stated, ValveFacts& facts) {
  const std::size_t before = context.problems.size();
  MapReader reader(context.document, node, context.problems, "the valve of " + who);
  drivers::OutputWiring wiring;
  wiring.module = read_module(context, reader, "output");
  wiring.output = read_terminal(context, reader, "output", wiring.module, context.outputs);
  const ElectricalKey at = electrical_key(reader, "at");
  wiring.unit = at.unit;
  wiring.scaling = read_scaling(reader, at, "is_kpa", line_pressure_kpa);
  check_unit(reader, at, terminal_of(context, "output", wiring.module, wiring.output));
  const auto range = reader.numbers("range_kpa", 2, line_pressure_kpa);
  facts.range_min_kpa = range[0];
  facts.range_max_kpa = range[1];
  if (reader.good("range_kpa") && range[0] >= range[1]) {
    reader.report("range_kpa", "the first number of `range_kpa` must be smaller than the second");
  }
  read_keys(reader, rig_keys().valve, facts);
  if (reader.has("on_power_loss_kpa") && reader.good("on_power_loss") &&
      facts.on_power_loss == PowerLoss::holds) {
    reader.report("on_power_loss_kpa",
                  "with `on_power_loss: holds`, no other pressure on power loss is possible",
                  "leave `on_power_loss_kpa` out, or write `on_power_loss: vents`");
  }
  reader.finish();
  const bool limits_known = limits.pressure_max_kpa > limits.pressure_min_kpa;
  const bool known = all_good(reader, {at.name, "is_kpa", "range_kpa", "on_power_loss"});
  if (context.problems.size() == before && known && limits_known) {
    check_valve(context, reader, at, wiring, limits, facts);
    check_power_loss(reader, who, limits, rest_stated, facts);
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
  const std::string suffix(suffix_of(wiring.unit));
  const bool known = all_good(reader, {"at" + suffix, "is_mm", "valid" + suffix});
  if (context.problems.size() == before && known && limits_known) check_sensor(reader, wiring, limits);
  return wiring;
}

drivers::InputWiring read_pressure_monitor(Context& context, const Node& node, const std::string& who) {
  MapReader reader(context.document, node, context.problems, "the pressure monitor of " + who);
  return read_input(context, reader, "pressure monitor of " + who, "is_kpa", line_pressure_kpa);
}

drivers::InputWiring read_temperature_sensor(Context& context, const Node& node, const std::string& who) {
  MapReader reader(context.document, node, context.problems, "the temperature sensor of " + who);
  return read_input(context, reader, "temperature sensor of " + who, "is_c", {-100, 300},
                    &context.thermometers);
}

}  // namespace softgrip::rig
