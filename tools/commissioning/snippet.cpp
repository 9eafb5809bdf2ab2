#include "tools/commissioning/calibration_results.h"

#include <cmath>

#include <fmt/format.h>

#include "base/numbers.h"
#include "base/text.h"
#include "rig/board_map_file.h"
#include "rig/rig_file.h"

namespace softgrip::tools::calibrate {
namespace {

std::string pair(double first, double second, int decimals) {
  return "[" + rounded(first, decimals) + ", " + rounded(second, decimals) + "]";
}

/// Returns the two points of a scaling as text: `at_v: [1.2, 7.8], is_mm: [3, 21]`.
std::string scaling(const drivers::TwoPoints& points, std::string_view electrical, const std::string& unit) {
  const LineText text = text_of(points);
  return fmt::format("at{}: [{}, {}], is_{}: [{}, {}]", electrical, text.at.first, text.at.second, unit,
                     text.is.first, text.is.second);
}

std::string error_codes(const drivers::InputWiring& wiring) {
  if (wiring.error_codes.empty()) return {};
  const std::string_view electrical = rig::suffix_of(wiring.unit);
  const auto text_of = [&](const auto& code) {
    return fmt::format("{{at{}: {}, tolerance{}: {}}}", electrical, written(code.electrical), electrical,
                       written(code.tolerance));
  };
  return ", error_codes: [" + with_commas(wiring.error_codes, text_of) + "]";
}

/// Returns the key `module` with its value if the board has several modules, otherwise "".
std::string module_of(const rig::RigFile& rig, std::size_t module) {
  const auto* const board = std::get_if<drivers::ModbusSettings>(&rig.board);
  if (board == nullptr || board->modules.size() < 2 || module >= board->modules.size()) return {};
  return "module: " + board->modules[module].name + ", ";
}

std::string input(const rig::RigFile& rig, const std::string& key, const drivers::InputWiring& wiring,
                  const drivers::TwoPoints& points, const std::string& unit) {
  const std::string_view electrical = rig::suffix_of(wiring.unit);
  return fmt::format("{}: {{{}input: {}, {}, valid{}: {}{}}}\n", key, module_of(rig, wiring.module),
                     wiring.input, scaling(points, electrical, unit), electrical,
                     pair(wiring.valid_min, wiring.valid_max, 5), error_codes(wiring));
}

std::string findings(const std::string& what, const Line& line, const std::string& unit) {
  const std::string residuals =
      with_commas(line.residuals, [](double residual) { return rounded(residual, 4); });
  return fmt::format(
      "# {}: error between the points {} {} (without the error of the reference instrument), noise of a "
      "reading {} "
      "{},\n#   residuals [{}] {}, repeatability {}\n",
      what, rounded(line.error, 4), unit, rounded(line.noise, 4), unit, residuals, unit,
      line.repeat_spread ? rounded(*line.repeat_spread, 4) + " " + unit
                         : "unknown (each point was measured only once)");
}

std::string valve_line(const rig::RigFile& rig, std::size_t channel, const drivers::TwoPoints& points) {
  const drivers::OutputWiring& wiring = rig.wiring[channel].valve;
  const rig::ValveFacts& facts = rig.valves[channel];
  return fmt::format(
      "valve: {{{}output: {}, {}, range_kpa: {}, on_power_loss: {}}}\n", module_of(rig, wiring.module),
      wiring.output, scaling(points, rig::suffix_of(wiring.unit), "kpa"),
      pair(facts.range_min_kpa, facts.range_max_kpa, 4),
      facts.on_power_loss == rig::PowerLoss::holds ? "holds"
      : facts.power_loss_kpa == 0                  ? "vents"
                                  : fmt::format("vents, on_power_loss_kpa: {:g}", facts.power_loss_kpa));
}

std::string dead_zone_lines(const DeadZoneResult& result, double rest_kpa) {
  const DeadZone& zone = *result.zone;
  const std::string by = result.by_pressure
                             ? "the pressure monitor"
                             : "the motion of the finger (less reliable, because the finger has hysteresis)";
  if (!zone.significant) {
    return fmt::format("# dead zone: none detected up to {} kPa, measured by {}\n",
                       rounded(result.highest_kpa, 3), by);
  }
  return fmt::format(
      "# dead zone: commands between rest and {} kPa (width {} kPa) have no effect, measured by {}\n",
      rounded(zone.end, 2), rounded(std::abs(zone.end - rest_kpa), 2), by);
}

}  // namespace

std::string rounded(double value, int decimals) {
  const double scale = std::pow(10, decimals);
  return written(std::round(value * scale) / scale + 0.0);
}

LineText text_of(const drivers::TwoPoints& points) {
  return {{rounded(points.x0, 5), rounded(points.x1, 5)}, {rounded(points.y0, 4), rounded(points.y1, 4)}};
}

std::string snippet(const rig::RigFile& rig, const Results& results) {
  const std::size_t channel = results.channel;
  const drivers::ChannelWiring& wiring = rig.wiring[channel];
  const control::ChannelSettings& settings = rig.settings.channels[channel];
  std::string text =
      fmt::format("# softgrip calibrate, {}: rig {}, channel {}\n", results.date, rig.name, settings.name);
  if (results.sensor) {
    text += findings("sensor", *results.sensor, "mm");
    text += fmt::format("#   the signal {} with increasing displacement\n",
                        results.sensor->slope > 0 ? "rises" : "falls");
    text += input(rig, "sensor", wiring.displacement, results.sensor->points, "mm");
  }
  if (results.valve) {
    text += findings(
        results.valve->by_monitor ? "valve, against the pressure monitor" : "valve, against a manometer",
        results.valve->valve, "kPa");
    text += valve_line(rig, channel, results.valve->valve.points);
    if (results.valve->monitor) {
      text += findings("pressure monitor, against a manometer", *results.valve->monitor, "kPa");
      text += input(rig, "pressure_monitor", *wiring.pressure, results.valve->monitor->points, "kpa");
    }
  }
  if (results.dead_zone) text += dead_zone_lines(*results.dead_zone, control::resting_kpa(settings.limits));
  const double share = share_of_valve(rig, channel);
  text +=
      fmt::format("# the limits use {:.0f} % of the valve's range{}\n", 100 * share,
                  share < least_share_of_valve ? ": a share of less than 1/5 reduces the resolution and the "
                                                 "linearity of the pressure; use a valve with a smaller range"
                                               : "");
  return text;
}

}  // namespace softgrip::tools::calibrate
