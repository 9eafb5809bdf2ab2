#include "drivers/channel_wiring.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace softgrip::drivers {
namespace {

std::string of_channel(const ChannelWiring& channel, const std::string& part) {
  return "channel '" + channel.name + "', " + part + ": ";
}

class Checker {
 public:
  Checker(const BoardMap& map, std::vector<std::string>& problems) : map_(map), problems_(problems) {}

  void valve(const ChannelWiring& channel) {
    const std::string where = of_channel(channel, "valve");
    terminal(where, "output", channel.valve.output, map_.outputs, outputs_);
    unit(where, channel.valve.unit, map_.outputs.unit);
    scaling(where, channel.valve.scaling);
  }

  void sensor(const ChannelWiring& channel, const InputWiring& input, const std::string& part) {
    const std::string where = of_channel(channel, part);
    terminal(where, "input", input.input, map_.inputs, inputs_);
    unit(where, input.unit, map_.inputs.unit);
    scaling(where, input.scaling);
    if (!(input.valid_min < input.valid_max)) {
      problems_.push_back(where + "the electrical range of valid readings is empty");
    }
    for (const SensorErrorCode& code : input.error_codes) {
      if (!(code.tolerance >= 0)) {
        problems_.push_back(where + "the tolerance of an error code is below 0");
      }
    }
  }

 private:
  void terminal(const std::string& where, const std::string& kind, std::size_t index,
                const TerminalBlock& block, std::set<std::size_t>& used) {
    if (index >= block.registers.count) {
      problems_.push_back(where + map_.name + " has no " + kind + " " + std::to_string(index) + "; it has " +
                          std::to_string(block.registers.count) + ", counted from 0");
    } else if (!used.insert(index).second) {
      problems_.push_back(where + kind + " " + std::to_string(index) + " is wired twice");
    }
  }

  void unit(const std::string& where, ElectricalUnit wired, ElectricalUnit board) {
    if (wired == board) return;
    problems_.push_back(where + "wired in " + std::string(name_of(wired)) + ", but " + map_.name +
                        " has this terminal in " + std::string(name_of(board)));
  }

  void scaling(const std::string& where, const TwoPoints& points) {
    const bool finite = std::isfinite(points.x0) && std::isfinite(points.y0) && std::isfinite(points.x1) &&
                        std::isfinite(points.y1);
    if (!finite || points.x0 == points.x1 || points.y0 == points.y1) {
      problems_.push_back(where + "the two scaling points must differ in both their numbers");
    }
  }

  const BoardMap& map_;
  std::vector<std::string>& problems_;
  std::set<std::size_t> outputs_;
  std::set<std::size_t> inputs_;
};

}  // namespace

std::vector<std::string> wiring_problems(const BoardMap& map, std::span<const ChannelWiring> wiring) {
  std::vector<std::string> problems;
  if (wiring.empty()) problems.emplace_back("no channel is wired");
  Checker checker(map, problems);
  for (const ChannelWiring& channel : wiring) {
    checker.valve(channel);
    checker.sensor(channel, channel.displacement, "displacement");
    if (channel.pressure.has_value()) checker.sensor(channel, *channel.pressure, "pressure");
  }
  return problems;
}

}  // namespace softgrip::drivers
