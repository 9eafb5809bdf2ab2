// Makes the checks of a rig file that combine several of its parts.

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/numbers.h"
#include "document/node.h"
#include "rig/rig_file_reader.h"

namespace softgrip::rig {

namespace {

/// Returns the pressure that a valve gets when the watchdog of its Modbus module trips; nothing if the module
/// has no watchdog.
std::optional<double> safe_value_kpa(const drivers::OutputWiring& valve, const ValveFacts& facts,
                                     const drivers::ModbusSettings& board) {
  if (valve.module >= board.modules.size()) return std::nullopt;
  const drivers::BoardWatchdog& watchdog = board.modules[valve.module].map.watchdog;
  if (watchdog.kind == drivers::BoardWatchdog::Kind::none) return std::nullopt;
  if (valve.output >= watchdog.safe_electrical.size()) return std::nullopt;
  const double asked_kpa = valve.scaling.y_at(watchdog.safe_electrical[valve.output]);
  return std::clamp(asked_kpa, facts.range_min_kpa, facts.range_max_kpa);
}

/// Returns nothing if the watchdog of a Modbus board sets each channel to its rest pressure. Otherwise
/// returns the reason as a text that is appended to a message. If a module has no watchdog, the text is
/// empty.
std::optional<std::string> stays_away(const Context& context, const drivers::ModbusSettings& board) {
  for (std::size_t i = 0; i < context.wiring.size(); ++i) {
    const std::optional<double> safe_kpa =
        safe_value_kpa(context.wiring[i].valve, context.rig.valves[i], board);
    if (!safe_kpa) return "";
    const control::LimitSettings& limits = context.rig.settings.channels[i].limits;
    if (is_rest(limits, *safe_kpa)) continue;
    return ": the watchdog of the board sets channel `" + context.wiring[i].name + "` to " +
           written(*safe_kpa) + " kPa, but the rest pressure of this channel is " +
           written(control::resting_kpa(limits)) + " kPa";
  }
  return std::nullopt;
}

/// Returns true if all channels of an industrial I/O board go to their rest pressure when the external
/// circuit of the heartbeat switches off the valves.
bool heartbeat_vents(const Context& context, const drivers::IioSettings& board) {
  for (std::size_t i = 0; i < context.wiring.size(); ++i) {
    const ValveFacts& valve = context.rig.valves[i];
    const control::LimitSettings& limits = context.rig.settings.channels[i].limits;
    if (valve.on_power_loss == PowerLoss::holds || !is_rest(limits, valve.power_loss_kpa)) return false;
  }
  return board.heartbeat.has_value();
}

void check_watchdog(Context& context, MapReader& top) {
  context.rig.settings.safety.board_vents_when_silent = board_vents_when_silent(context);
  const bool accepted = !context.rig.accept_no_watchdog.empty();
  if (context.rig.settings.safety.board_vents_when_silent) {
    if (accepted)
      top.warn("safety",
               "`accept_no_watchdog` is not needed, because this board vents by itself when softgripd stops");
    return;
  }
  if (accepted) return;
  const auto* const modbus = std::get_if<drivers::ModbusSettings>(&context.rig.board);
  top.report(
      "board",
      "this board does not vent by itself when softgripd dies, and the rig file does not accept this risk" +
          (modbus != nullptr ? stays_away(context, *modbus).value_or("") : ""),
      "to accept the risk, write under `safety`: accept_no_watchdog: \"" + std::string(no_watchdog_words) +
          "\"");
}

/// Returns the shortest time without messages after which the board sets an output to its safe value [s]; 0
/// if the board never does this.
double watchdog_time_s(const Context& context) {
  if (const auto* modbus = std::get_if<drivers::ModbusSettings>(&context.rig.board)) {
    return seconds(drivers::ModbusBoard(*modbus).watchdog_time().count());
  }
  if (const auto* converters = std::get_if<drivers::IioSettings>(&context.rig.board))
    return converters->heartbeat ? converters->heartbeat->timeout_s : 0;
  const auto* simulated = std::get_if<simulation::SimulatedBoardSettings>(&context.rig.board);
  return simulated != nullptr ? simulated->watchdog_timeout_s : 0;
}

/// Checks that a gap in the communication causes the fault bus_down before the board's watchdog vents. After
/// a gap that is too short for this fault, the sequence continues. If the board had vented in this gap, the
/// sequence would continue with vented fingers.
void check_watchdog_time(Context& context, MapReader& top) {
  const double timeout_s = watchdog_time_s(context);
  const std::chrono::nanoseconds timeout(nanoseconds(timeout_s));
  const double longest_s = seconds((timeout - watchdog_margin(context.rig.loop, timeout)).count());
  const double patience_s = context.rig.settings.faults.bus_down_cycles * context.period_s();
  if (timeout_s > 0 && patience_s >= longest_s) {
    const double most_cycles = std::ceil(longest_s / context.period_s()) - 1;
    top.report("faults",
               "`bus_down_cycles` correspond to " + written(patience_s) +
                   " s. By this time, the board's watchdog (" + written(timeout_s) +
                   " s, minus the time of an exchange) has already vented",
               most_cycles >= 1 ? "at most " + written(most_cycles) + " cycles"
                                : "even 1 cycle is too long: set a longer time of the board's watchdog, or a "
                                  "higher `rate_hz`");
  }
  if (timeout_s > 0 && timeout_s < 3 * context.period_s()) {
    top.warn("board",
             "the board's watchdog sets the safe outputs after " + written(timeout_s) +
                 " s, which is less than three cycles",
             "a single late exchange with the board would vent the fingers");
  }
}

/// Checks that the bus is fast enough for the rate. With `accept_over_budget`, the user accepts a rate above
/// the budget, for example because the round-trip time of a network is only an estimate. The transmission
/// time on a serial line is exact, so the deadline of an exchange must always cover it.
void check_budget(Context& context, MapReader& top) {
  const auto* const settings = std::get_if<drivers::ModbusSettings>(&context.rig.board);
  if (settings == nullptr) return;
  const drivers::Board::Budget budget = drivers::ModbusBoard(*settings).budget();
  const bool serial = context.board_key == "modbus_rtu";
  if (serial && budget.exchange_s > context.rig.loop.exchange_deadline_s) {
    top.report("board",
               "an exchange with the board takes longer than `exchange_deadline_s`: " + budget.explanation,
               "set a longer deadline or a higher `baud`, or use fewer terminals");
  }
  if (context.rig.accept_over_budget || budget.exchange_s <= context.period_s()) return;
  top.report("rate_hz",
             "the bus is not fast enough for " + written(context.rig.settings.rate_hz) +
                 " exchanges a second: " + budget.explanation,
             "lower rate_hz or, if you know that the bus is faster than computed, write `accept_over_budget: "
             "true` under `" +
                 context.board_key + "`");
}

/// Returns true if the board can be created with this wiring.
bool check_wiring(Context& context, MapReader& top) {
  const std::size_t before = context.problems.size();
  if (auto* const modbus = std::get_if<drivers::ModbusSettings>(&context.rig.board)) {
    modbus->wiring = context.wiring;
    for (std::string& sentence : drivers::problems_of(*modbus)) {
      top.report("channels", std::move(sentence));
    }
  }
  if (auto* const converters = std::get_if<drivers::IioSettings>(&context.rig.board)) {
    converters->wiring = context.wiring;
    const drivers::ModuleTerminals terminals = drivers::terminals_of(*converters);
    for (std::string& sentence : drivers::wiring_problems({&terminals, 1}, converters->wiring)) {
      top.report("channels", std::move(sentence));
    }
  }
  return context.problems.size() == before;
}

}  // namespace

bool board_vents_when_silent(const Context& context) {
  if (const auto* simulated = std::get_if<simulation::SimulatedBoardSettings>(&context.rig.board)) {
    return simulated->watchdog_timeout_s > 0;
  }
  if (const auto* converters = std::get_if<drivers::IioSettings>(&context.rig.board))
    return heartbeat_vents(context, *converters);
  const auto* modbus = std::get_if<drivers::ModbusSettings>(&context.rig.board);
  return modbus != nullptr && !stays_away(context, *modbus);
}

void check_whole(Context& context, MapReader& top) {
  context.rig.wiring = context.wiring;
  const Context::Sound& sound = context.sound;
  if (!sound.board || !sound.channels || !check_wiring(context, top)) return;
  if (sound.safety) check_watchdog(context, top);
  if (sound.faults && context.rate_known) check_watchdog_time(context, top);
  const bool settings_known =
      context.rate_known && sound.faults && sound.safety && sound.detection && sound.rest;
  if (settings_known) {
    for (std::string& sentence : control::settings_problems(context.rig.settings)) {
      top.report("channels", std::move(sentence));
    }
  }
  if (context.rate_known && sound.loop) check_budget(context, top);
}

}  // namespace softgrip::rig
