#include "daemon/service/daemon.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/version.h"

namespace softgrip::daemon {

namespace {

constexpr double ms_per_s = 1e3;

std::string bus_lines(const rig::RigFile& rig, const drivers::Board& board) {
  const double period_s = 1 / rig.settings.rate_hz;
  const drivers::Board::Budget budget = board.budget();
  const bool fits = budget.exchange_s <= period_s;
  std::string text =
      fmt::format("bus: {}; configured {:g} Hz: {}\n", budget.explanation, rig.settings.rate_hz,
                  fits ? "fits" : "DOES NOT FIT: some cycles will have no exchange with the board");
  const double offset_s = rig.loop.bus_offset_fraction * period_s;
  text += fmt::format(
      "latency: a command is written {:.3g} ms after the start of its cycle; a reading is {:.3g} ms old when "
      "the controller uses it\n",
      offset_s * ms_per_s, (period_s - offset_s) * ms_per_s);
  return text;
}

std::string watchdog_line(const rig::RigFile& rig, const drivers::Board& board, std::string_view program) {
  if (board.has_watchdog()) {
    const double time_s = seconds(board.watchdog_time().count());
    std::string text =
        fmt::format("watchdog: the board applies its safe outputs {:g} s after the last message from {}\n",
                    time_s, program);
    const auto& actions = rig.settings.safety.safe_action;
    if (rig.settings.safety.board_vents_when_silent &&
        std::find(actions.begin(), actions.end(), control::SafeAction::hold) != actions.end())
      text += fmt::format(
          "hold: a part is held only while {} runs; the watchdog vents the fingers {:g} s after the program "
          "ends\n",
          program, time_s);
    return text;
  }
  return fmt::format("watchdog: NONE on the board; accepted in the rig file: \"{}\"\n",
                     rig.accept_no_watchdog);
}

std::string channel_line(const control::ChannelSettings& channel, const rig::ValveFacts& valve) {
  const bool planned = channel.feedforward.kind == control::FeedforwardKind::planned;
  const double rest_kpa = control::resting_kpa(channel.limits);
  const bool rests_above = rest_kpa > channel.limits.pressure_min_kpa;
  return fmt::format("channel {}: {:g} to {:g} kPa{}, feedforward {} accepted{}, valve {} on power loss\n",
                     channel.name, channel.limits.pressure_min_kpa, channel.limits.pressure_max_kpa,
                     rests_above ? fmt::format(", rests at {:g} kPa", rest_kpa) : "",
                     name_of(channel.feedforward.kind),
                     planned ? " (each sequence is planned before its start)" : "",
                     valve.on_power_loss == rig::PowerLoss::vents ? "vents" : "holds");
}

/// Returns the lines about the GPIO. They contain the response time of an emergency stop: the debounce time,
/// plus one cycle until the next tick, plus the time from this tick to its exchange.
std::string gpio_lines(const rig::RigFile& rig) {
  std::string text;
  const rig::GpioSettings& gpio = *rig.gpio;
  for (const drivers::GpioLineSettings& line : gpio.lines) {
    text += fmt::format("gpio: {} is {}", drivers::name_of(line.role), drivers::text_of(line));
    if (line.role == drivers::GpioRole::enable) {
      text += gpio.keeps_enable_on_fault ? ", stays on during a fault" : ", switched off on a fault";
    }
    text += "\n";
  }
  if (!gpio.has(drivers::GpioRole::emergency_stop)) return text;
  const double period_s = 1 / rig.settings.rate_hz;
  const double latched_s = gpio.debounce_s + period_s;
  return text +
         fmt::format(
             "emergency stop: detected {:.3g} ms after the contact switches (debounce {:.3g} ms + 1 cycle), "
             "written to the board {:.3g} ms later. Acknowledge the emergency stop before the first start\n",
             latched_s * ms_per_s, gpio.debounce_s * ms_per_s,
             rig.loop.bus_offset_fraction * period_s * ms_per_s);
}

}  // namespace

std::string startup_report(const rig::RigFile& rig, const drivers::Board& board,
                           const RealTimeReport* real_time, std::string_view program) {
  std::string text =
      fmt::format("{} {}\nrig: {} ({}), {} channels at {:g} Hz\nboard: {}\n", program, software_version(),
                  rig.name, rig.path, rig.settings.channels.size(), rig.settings.rate_hz, board.describe());
  text += bus_lines(rig, board);
  text += watchdog_line(rig, board, program);
  text += "safe action:";
  for (const auto& [phase, name] : control::phase_names) {
    const control::SafeAction action = rig.settings.safety.safe_action[static_cast<std::size_t>(phase)];
    text += fmt::format("{} {} {}", phase == control::Phase::idle ? "" : ",", name, control::name_of(action));
  }
  text += "\n";
  for (std::size_t i = 0; i < rig.settings.channels.size(); ++i) {
    text += channel_line(rig.settings.channels[i], rig.valves[i]);
  }
  if (rig.gpio) text += gpio_lines(rig);
  if (real_time == nullptr) return text;
  text +=
      fmt::format("real time: {}\n", real_time->degraded() ? "DEGRADED" : "all requested settings verified");
  std::string_view rest;
  const std::string details = real_time->format();
  for (rest = details; !rest.empty();) {
    const std::size_t end = rest.find('\n');
    text += fmt::format("  {}\n", rest.substr(0, end));
    rest.remove_prefix(end + 1);
  }
  return text;
}

}  // namespace softgrip::daemon
