#include "tools/commissioning/rig_draft.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <string_view>

#include <fmt/format.h>

#include "base/numbers.h"
#include "control/feedforward/free_curve.h"
#include "control/feedforward/invertibility.h"
#include "drivers/board/channel_wiring.h"
#include "rig/board_map_file.h"
#include "rig/rig_file.h"
#include "tools/commissioning/calibration_results.h"
#include "tools/commissioning/rig_template.h"

namespace softgrip::tools {
namespace {

using calibrate::rounded;
using drivers::ElectricalUnit;
using rig::suffix_of;

constexpr std::array<double, 8> usual_rates_hz{200, 100, 50, 40, 20, 10, 5, 2};
constexpr double bus_lag = 0.25;  // delay of the bus schedule after the loop schedule, as a share of the
                                  // period; equals LoopSettings::bus_offset_fraction
constexpr double simulated_watchdog_s = 0.5;
/// Range of valid signals outside the two end points, on each side, as a share of the distance between the
/// end points.
constexpr double beyond_ends = 0.01;

ElectricalRange usual_range(ElectricalUnit unit) noexcept {
  switch (unit) {
    case ElectricalUnit::volt:
      return {0, 10};
    case ElectricalUnit::milliampere:
      return {4, 20};
    case ElectricalUnit::kilopascal:
      return {0, 100};
  }
  return {};
}

std::string two(double value) {
  return rounded(value, 2);
}

/// Returns the value with four decimals. The pressure limits and the range of the valve are rounded in the
/// same way, so that a limit at the end of the range does not exceed the range.
std::string four(double value) {
  return rounded(value, 4);
}

std::string pair_text(double first, double second) {
  return "[" + four(first) + ", " + four(second) + "]";
}

/// Largest number of fingers in one rig file.
constexpr std::size_t max_fingers = 16;

/// Returns the text as a YAML scalar. Puts the text in single quotes if it contains a character that can have
/// a meaning in YAML.
std::string scalar_text(const std::string& text) {
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.' || c == '/';
  };
  if (std::all_of(text.begin(), text.end(), plain)) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? "''" : std::string(1, c);
  return quoted + "'";
}

/// Returns the path as the rig file must contain it: relative to the rig file's folder if the path is in this
/// folder or below it, otherwise absolute.
std::string named(const std::string& path, const std::filesystem::path& folder) {
  const auto relative = std::filesystem::proximate(path, folder);
  if (relative.empty() || relative.begin()->string() == "..")
    return scalar_text(std::filesystem::absolute(path).lexically_normal().string());
  return scalar_text(relative.string());
}

double watchdog_s(const RigDraft& draft) {
  double shortest = draft.modules.empty() ? simulated_watchdog_s : 0;
  for (const DraftModule& module : draft.modules) {
    const double timeout_s = module.map.watchdog.timeout_s;
    if (timeout_s > 0 && (shortest == 0 || timeout_s < shortest)) shortest = timeout_s;
  }
  return shortest;
}

control::LimitSettings limits_of(const RigDraft& draft) {
  control::LimitSettings limits;
  limits.pressure_min_kpa = std::max(0.0, std::min(draft.valve.y0, draft.valve.y1));
  limits.pressure_max_kpa = draft.pressure_max_kpa;
  const double span_kpa = limits.pressure_max_kpa - limits.pressure_min_kpa;
  limits.slew_up_kpa_per_s = 5 * span_kpa;
  limits.slew_down_kpa_per_s = 10 * span_kpa;
  const control::FreeMotion motion = control::free_motion(draft.model, limits);
  const double travel_mm = std::max(motion.highest_mm - motion.lowest_mm, 0.1);
  const double sensor_mm = std::abs(draft.sensor.y1 - draft.sensor.y0);
  const double lowest_mm = std::min(draft.sensor.y0, draft.sensor.y1) + beyond_ends * sensor_mm;
  const double highest_mm = std::max(draft.sensor.y0, draft.sensor.y1) - beyond_ends * sensor_mm;
  limits.displacement_min_mm = std::max(lowest_mm, motion.lowest_mm - 0.1 * travel_mm);
  limits.displacement_max_mm = std::min(highest_mm, motion.highest_mm + 0.25 * travel_mm);
  limits.displacement_margin_mm = 2;
  return limits;
}

/// Returns the best kind of feedforward that the model supports.
control::FeedforwardKind feedforward_of(const RigDraft& draft, const control::LimitSettings& limits,
                                        double period_s) {
  for (const auto kind : {control::FeedforwardKind::full_model, control::FeedforwardKind::planned}) {
    if (control::check_feedforward(draft.model, {kind, bus_lag * period_s}, limits, period_s)) return kind;
  }
  return control::FeedforwardKind::none;
}

std::string modules_text(const RigDraft& draft, const std::filesystem::path& folder) {
  const bool several = draft.modules.size() > 1;
  std::string text = several ? "    modules:\n" : "";
  for (std::size_t i = 0; i < draft.modules.size(); ++i) {
    const std::string map = named(draft.modules[i].path, folder);
    const int unit = draft.unit + static_cast<int>(i);
    const std::string place =
        draft.host.empty() ? "" : fmt::format("host: {}, port: {}, ", draft.host, draft.port);
    if (several) {
      text += fmt::format("      - {{name: module_{}, map: {}, {}unit: {}}}\n", i + 1, map, place, unit);
      continue;
    }
    text += fmt::format("    map: {}\n", map);
    if (!draft.host.empty()) text += fmt::format("    host: {}\n    port: {}\n", draft.host, draft.port);
    text += fmt::format("    unit: {}\n", unit);
  }
  return text;
}

std::string simulated_text(const RigDraft& draft, const std::filesystem::path& folder) {
  std::string text = fmt::format(
      "  simulated:                       # nothing is connected, nothing can move\n    seed: 1\n"
      "    watchdog_timeout_s: {}\n    output_bits: 12\n    input_bits: 16\n"
      "    plants:                        # the simulated finger of each channel\n",
      two(simulated_watchdog_s));
  for (const std::string& finger : draft.fingers) {
    text += fmt::format("      {}: {{model: {}, displacement_noise_mm: 0.03, pressure_noise_kpa: 0.1}}\n",
                        finger, named(draft.model_path, folder));
  }
  return text;
}

std::string board_text(const RigDraft& draft, double rate_hz, const std::filesystem::path& folder) {
  if (draft.modules.empty()) return simulated_text(draft, folder);
  std::string text;
  if (draft.host.empty()) {
    text = fmt::format(
        "  modbus_rtu:\n    device: {}   # the adapter's own name: ls -l /dev/serial/by-id\n    baud: {}\n   "
        " format: 8N1\n"
        "    turnaround_s: 0.005            # response time of a module; softgrip doctor measures the "
        "bus\n",
        draft.device, draft.baud);
  } else {
    text = "  modbus_tcp:\n";
  }
  text += modules_text(draft, folder);
  const double deadline_s = std::clamp(2 / rate_hz, 0.02, 0.5);
  text += fmt::format(
      "    exchange_deadline_s: {:<9} # after this time an exchange has failed and the session is opened "
      "again\n    connect_deadline_s: 2\n    first_pause_s: 0.1             # pause between attempts to "
      "connect; it doubles\n    longest_pause_s: 2             # longest pause between attempts to connect\n",
      two(deadline_s));
  return text;
}

/// Returns the key `module` with its value, for example "module: module_2, ", if several modules of the board
/// are possible. Otherwise returns "".
std::string module_key(const RigDraft& draft, bool output) {
  std::size_t candidates = 0;
  std::size_t first = 0;
  for (std::size_t i = draft.modules.size(); i-- > 0;) {
    const bool has = output ? draft.modules[i].map.has_outputs() : draft.modules[i].map.has_inputs();
    if (!has) continue;
    ++candidates;
    first = i;
  }
  return candidates > 1 ? fmt::format("module: module_{}, ", first + 1) : "";
}

std::string channels_text(const RigDraft& draft) {
  const DraftModule* const inputs = input_module(draft);
  const std::size_t count = draft.fingers.size();
  const std::size_t first_monitor = inputs == nullptr ? count : inputs->map.inputs.registers.count - count;
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    text += fmt::format("  - name: {}\n    valve: {{{}output: {}}}\n    sensor: {{{}input: {}}}\n",
                        draft.fingers[i], module_key(draft, true), i, module_key(draft, false), i);
    if (!draft.monitor) continue;
    text +=
        fmt::format("    pressure_monitor: {{{}input: {}}}\n", module_key(draft, false), first_monitor + i);
  }
  return text;
}

std::string valid_text(const drivers::TwoPoints& points, std::string_view unit) {
  const double span = points.x1 - points.x0;
  return fmt::format("valid{}: {}", unit,
                     pair_text(points.x0 + beyond_ends * span, points.x1 - beyond_ends * span));
}

std::string monitor_text(const RigDraft& draft) {
  if (!draft.monitor) return "";
  const std::string_view unit = suffix_of(input_unit(draft));
  const ElectricalRange range = input_range(draft);
  const double span = range.highest - range.lowest;
  return fmt::format("  pressure_monitor: {{at{}: {}, is_kpa: {}, valid{}: {}}}\n", unit,
                     pair_text(range.lowest, range.highest), pair_text(draft.valve.y0, draft.valve.y1), unit,
                     pair_text(range.lowest - 0.02 * span, range.highest + 0.02 * span));
}

std::string pressure_fault_text(const RigDraft& draft, double rate_hz) {
  if (!draft.monitor) return "";
  const double range_kpa = std::abs(draft.valve.y1 - draft.valve.y0);
  return fmt::format(
      "  pressure_cycles: {:<15} # wrong pressure: a burst line, a lost supply\n"
      "  pressure_tolerance_kpa: {}\n  pressure_delay_s: 0.5            # longer than the delay of the valve "
      "with "
      "the line\n",
      std::max(3.0, std::round(0.1 * rate_hz)), two(0.05 * range_kpa));
}

/// Returns bus_down_cycles: the number of cycles without an exchange after which the daemon reports a bus
/// fault. If possible, the fault is reported before the board's watchdog trips.
int bus_patience(const RigDraft& draft, double rate_hz) {
  const double watchdog = watchdog_s(draft);
  if (watchdog <= 0) return 5;
  const double deadline_s = draft.modules.empty() ? 0.05 : std::clamp(2 / rate_hz, 0.02, 0.5);
  const double left_s = watchdog - std::min(deadline_s, watchdog / 2);
  return static_cast<int>(std::clamp(std::ceil(left_s * rate_hz) - 1, 1.0, 5.0));
}

using Values = std::vector<std::pair<std::string_view, std::string>>;

/// Replaces every `$key$` in the text by the value of this key.
std::string filled(std::string text, const Values& values) {
  for (const auto& [key, value] : values) {
    const std::string mark = "$" + std::string(key) + "$";
    for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at + value.size())) {
      text.replace(at, mark.size(), value);
    }
  }
  return text;
}

std::string text_at(const RigDraft& draft, double rate_hz, const std::filesystem::path& folder) {
  const control::LimitSettings limits = limits_of(draft);
  const control::FreeMotion motion = control::free_motion(draft.model, limits);
  const double gain = std::max(
      1e-6, (motion.highest_mm - motion.lowest_mm) / (limits.pressure_max_kpa - limits.pressure_min_kpa));
  const auto feedforward = feedforward_of(draft, limits, 1 / rate_hz);
  const std::string_view output = suffix_of(output_unit(draft));
  const std::string_view input = suffix_of(input_unit(draft));
  const std::string lines =
      draft.accepts_no_watchdog ? fmt::format("  accept_no_watchdog: \"{}\"\n", rig::no_watchdog_words) : "";
  const Values values{
      {"name", draft.name},
      {"rate_hz", two(rate_hz)},
      {"board", board_text(draft, rate_hz, folder)},
      {"model", named(draft.model_path, folder)},
      {"feedforward", std::string(control::name_of(feedforward))},
      {"kp", significant(0.3 / gain, 2)},
      {"ki", significant(1.5 / gain, 2)},
      {"pressure_min", four(limits.pressure_min_kpa)},
      {"pressure_max", four(limits.pressure_max_kpa)},
      {"slew_up", two(limits.slew_up_kpa_per_s)},
      {"slew_down", two(limits.slew_down_kpa_per_s)},
      {"displacement_min", rounded(limits.displacement_min_mm, 1)},
      {"displacement_max", rounded(limits.displacement_max_mm, 1)},
      {"valve",
       fmt::format(
           "{{at{}: {}, is_kpa: {}, range_kpa: {}, on_power_loss: vents}}", output,
           pair_text(draft.valve.x0, draft.valve.x1), pair_text(draft.valve.y0, draft.valve.y1),
           pair_text(std::min(draft.valve.y0, draft.valve.y1), std::max(draft.valve.y0, draft.valve.y1)))},
      {"sensor",
       fmt::format("{{at{}: {}, is_mm: {}, {}}}", input, pair_text(draft.sensor.x0, draft.sensor.x1),
                   pair_text(draft.sensor.y0, draft.sensor.y1), valid_text(draft.sensor, input))},
      {"monitor", monitor_text(draft)},
      {"channels", channels_text(draft)},
      {"watchdog", lines},
      {"bus_down", std::to_string(bus_patience(draft, rate_hz))},
      {"readback_delay", two(std::max(0.1, 2 / rate_hz))},
      {"pressure_fault", pressure_fault_text(draft, rate_hz)},
      {"max_age", two(std::max(0.05, 4 / rate_hz))},
      {"max_speed", significant(std::max(50.0, 3 * std::ceil(motion.fastest_mm_per_s)), 2)},
      {"runs", draft.service ? "/var/lib/softgrip/runs" : "/tmp/softgrip-runs"},
      {"socket", draft.service ? "/run/softgrip/softgripd.sock" : "/tmp/softgrip.sock"},
      {"sequences", named(draft.sequences_path, folder)},
  };
  return filled(std::string(rig_template), values);
}

}  // namespace

const DraftModule* output_module(const RigDraft& draft) noexcept {
  const auto found = std::find_if(draft.modules.begin(), draft.modules.end(),
                                  [](const DraftModule& module) { return module.map.has_outputs(); });
  return found == draft.modules.end() ? nullptr : &*found;
}

const DraftModule* input_module(const RigDraft& draft) noexcept {
  const auto found = std::find_if(draft.modules.begin(), draft.modules.end(),
                                  [](const DraftModule& module) { return module.map.has_inputs(); });
  return found == draft.modules.end() ? nullptr : &*found;
}

std::size_t most_fingers(const RigDraft& draft, bool monitor) noexcept {
  if (draft.modules.empty()) return max_fingers;
  const DraftModule* const outputs = output_module(draft);
  const DraftModule* const inputs = input_module(draft);
  if (outputs == nullptr || inputs == nullptr) return 0;
  const std::size_t sensors = inputs->map.inputs.registers.count / (monitor ? 2U : 1U);
  return std::min<std::size_t>({max_fingers, outputs->map.outputs.registers.count, sensors});
}

ElectricalRange output_range(const RigDraft& draft) {
  const DraftModule* const module = output_module(draft);
  if (module == nullptr || output_unit(draft) != ElectricalUnit::kilopascal)
    return usual_range(output_unit(draft));
  const drivers::Terminal terminal = drivers::terminals_of(module->map).outputs.front();
  return {terminal.lowest, terminal.highest};
}

ElectricalRange input_range(const RigDraft& draft) {
  return usual_range(input_unit(draft));
}

ElectricalUnit output_unit(const RigDraft& draft) noexcept {
  const DraftModule* const module = output_module(draft);
  return module == nullptr ? ElectricalUnit::volt : module->map.outputs.unit;
}

ElectricalUnit input_unit(const RigDraft& draft) noexcept {
  const DraftModule* const module = input_module(draft);
  return module == nullptr ? ElectricalUnit::volt : module->map.inputs.unit;
}

bool has_watchdog(const RigDraft& draft) noexcept {
  const DraftModule* const module = output_module(draft);
  return module == nullptr || module->map.watchdog.kind != drivers::BoardWatchdog::Kind::none;
}

tl::expected<std::string, document::Problems> draft_text(const RigDraft& draft, const std::string& path) {
  const auto folder = std::filesystem::absolute(path).parent_path();
  document::Problems problems;
  const auto accepted = [&](double rate_hz) -> std::optional<std::string> {
    problems = {};
    std::string text = text_at(draft, rate_hz, folder);
    if (!rig::read_rig(document::parse(path, text, problems), problems)) return std::nullopt;
    return text;
  };
  if (draft.rate_hz) {
    if (auto text = accepted(*draft.rate_hz)) return *std::move(text);
    return tl::unexpected(problems);
  }
  for (const double rate_hz : usual_rates_hz) {
    if (auto text = accepted(rate_hz)) return *std::move(text);
  }
  return tl::unexpected(problems);
}

}  // namespace softgrip::tools
