#include "drivers/board/channel_wiring.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace softgrip::drivers {
namespace {

std::string of_channel(const ChannelWiring& channel, const std::string& part) {
  return "channel '" + channel.name + "', " + part + ": ";
}

class Checker {
 public:
  Checker(std::span<const ModuleTerminals> modules, std::vector<std::string>& problems)
      : modules_(modules), problems_(problems) {}

  void valve(const ChannelWiring& channel) {
    const std::string where = of_channel(channel, "valve");
    const OutputWiring& valve = channel.valve;
    if (!known(where, valve.module)) return;
    terminal(where, "output", valve.module, valve.output, modules_[valve.module].outputs, outputs_,
             valve.unit);
    scaling(where, valve.scaling);
  }

  void sensor(const ChannelWiring& channel, const InputWiring& input, const std::string& part) {
    const std::string where = of_channel(channel, part);
    if (!known(where, input.module)) return;
    terminal(where, "input", input.module, input.input, modules_[input.module].inputs, inputs_, input.unit);
    scales(where, input);
  }

  /// Checks the wiring of a temperature sensor. Several channels may share one temperature sensor.
  void thermometer(const ChannelWiring& channel, const InputWiring& input) {
    if (!thermometers_.emplace(input.module, input.input).second) {
      scales(of_channel(channel, "temperature"), input);
    } else {
      sensor(channel, input, "temperature");
    }
  }

  void modules_without_a_wire() {
    const auto wired = [](const Used& used, std::size_t module) {
      return std::any_of(used.begin(), used.end(), [&](const auto& one) { return one.first == module; });
    };
    for (std::size_t i = 0; i < modules_.size(); ++i) {
      if (!wired(outputs_, i) && !wired(inputs_, i)) {
        problems_.push_back("no channel is wired to the module '" + modules_[i].name + "'");
      }
    }
  }

 private:
  void scales(const std::string& where, const InputWiring& input) {
    scaling(where, input.scaling);
    if (!(input.valid_min < input.valid_max)) {
      problems_.push_back(where + "the lowest valid signal must be below the highest valid signal");
    }
    for (const SensorErrorCode& code : input.error_codes) {
      if (!(code.tolerance >= 0)) {
        problems_.push_back(where + "the tolerance of an error code is below 0");
      }
    }
  }

  using Used = std::set<std::pair<std::size_t, std::size_t>>;

  bool known(const std::string& where, std::size_t module) {
    if (module < modules_.size()) return true;
    problems_.push_back(where + "there is no module " + std::to_string(module));
    return false;
  }

  void terminal(const std::string& where, const std::string& kind, std::size_t module, std::size_t index,
                const std::vector<Terminal>& terminals, Used& used, ElectricalUnit wired) {
    const std::string& name = modules_[module].name;
    if (index >= terminals.size()) {
      problems_.push_back(where + name + " has no " + kind + " " + std::to_string(index) + "; it has " +
                          std::to_string(terminals.size()) + ", numbered from 0");
      return;
    }
    if (!used.emplace(module, index).second) {
      problems_.push_back(where + kind + " " + std::to_string(index) + " is wired twice");
    }
    if (wired != terminals[index].unit) {
      problems_.push_back(where + "the wiring states " + std::string(name_of(wired)) +
                          ", but the unit of this terminal of " + name + " is " +
                          std::string(name_of(terminals[index].unit)));
    }
  }

  void scaling(const std::string& where, const TwoPoints& points) {
    const bool finite = std::isfinite(points.x0) && std::isfinite(points.y0) && std::isfinite(points.x1) &&
                        std::isfinite(points.y1);
    if (!finite || points.x0 == points.x1 || points.y0 == points.y1) {
      problems_.push_back(where + "the values of the two scaling points must differ in both coordinates");
    }
  }

  std::span<const ModuleTerminals> modules_;
  std::vector<std::string>& problems_;
  Used outputs_;
  Used inputs_;
  Used thermometers_;
};

std::vector<Terminal> terminals_of(const TerminalBlock& block) {
  const double a = block.scaling.y_at(block.raw_min);
  const double b = block.scaling.y_at(block.raw_max);
  return {block.registers.count, Terminal{block.unit, std::min(a, b), std::max(a, b)}};
}

}  // namespace

ModuleTerminals terminals_of(const BoardMap& map) {
  return {map.name, terminals_of(map.inputs), terminals_of(map.outputs)};
}

std::vector<std::string> wiring_problems(std::span<const ModuleTerminals> modules,
                                         std::span<const ChannelWiring> wiring) {
  std::vector<std::string> problems;
  if (wiring.empty()) problems.emplace_back("no channel is wired");
  Checker checker(modules, problems);
  for (const ChannelWiring& channel : wiring) {
    checker.valve(channel);
    checker.sensor(channel, channel.displacement, "displacement");
    if (channel.pressure.has_value()) checker.sensor(channel, *channel.pressure, "pressure");
    if (channel.temperature.has_value()) checker.thermometer(channel, *channel.temperature);
  }
  if (!wiring.empty()) checker.modules_without_a_wire();
  return problems;
}

std::vector<std::string> wiring_problems(const BoardMap& map, std::span<const ChannelWiring> wiring) {
  const ModuleTerminals terminals = terminals_of(map);
  return wiring_problems({&terminals, 1}, wiring);
}

}  // namespace softgrip::drivers
