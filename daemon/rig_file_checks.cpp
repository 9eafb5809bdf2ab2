// What only the whole rig shows.

#include "daemon/rig_file_reader.h"
#include "model/document/number.h"

namespace softgrip::daemon::rig_file {

namespace {

using document::written;

/// Modbus: the safe value of each output in use is at or below the lowest pressure of its limits.
bool vents(const Context& context, const drivers::BoardWatchdog& watchdog) {
  if (watchdog.kind == drivers::BoardWatchdog::Kind::none) return false;
  for (std::size_t i = 0; i < context.wiring.size(); ++i) {
    const drivers::OutputWiring& valve = context.wiring[i].valve;
    if (valve.output >= watchdog.safe_electrical.size()) return false;
    const double pressure = valve.scaling.y_at(watchdog.safe_electrical[valve.output]);
    const control::LimitSettings& limits = context.rig.settings.channels[i].limits;
    const double slack = 0.01 * (limits.pressure_max_kpa - limits.pressure_min_kpa);
    if (pressure > limits.pressure_min_kpa + slack) return false;
  }
  return true;
}

void check_watchdog(Context& context, MapReader& top) {
  context.rig.settings.safety.board_vents_when_silent = board_vents_when_silent(context);
  const bool accepted = !context.rig.accept_no_watchdog.empty();
  if (context.rig.settings.safety.board_vents_when_silent) {
    if (accepted) top.warn("safety", "`accept_no_watchdog` is not needed: this board vents by itself");
    return;
  }
  if (accepted) return;
  top.report(
      "board", "this board does not vent by itself when softgripd dies, and the rig does not accept that",
      "to accept it, write under `safety`: accept_no_watchdog: \"" + std::string(no_watchdog_words) + "\"");
}

void check_watchdog_time(Context& context, MapReader& top) {
  double timeout_s = 0;
  if (context.map && context.map->watchdog.kind != drivers::BoardWatchdog::Kind::none) {
    timeout_s = context.map->watchdog.timeout_s;
  }
  if (const auto* simulated = std::get_if<drivers::SimulatedBoardSettings>(&context.rig.board)) {
    timeout_s = simulated->watchdog_timeout_s;
  }
  if (timeout_s > 0 && timeout_s < 3 * context.period_s()) {
    top.warn("board", "the board's watchdog acts after " + written(timeout_s) + " s, less than three cycles",
             "one late exchange would vent the fingers");
  }
}

/// The round trip of a network is an assumption until it is measured: whoever knows better says so.
void check_budget(Context& context, MapReader& top) {
  const auto* const settings = std::get_if<drivers::ModbusTcpSettings>(&context.rig.board);
  if (settings == nullptr || context.rig.accept_over_budget) return;
  const drivers::Board::Budget budget = drivers::ModbusTcpBoard(*settings).budget();
  if (budget.exchange_s <= context.period_s()) return;
  top.report("rate_hz",
             "the bus is not fast enough for " + written(context.rig.settings.rate_hz) +
                 " exchanges a second: " + budget.explanation,
             "lower the rate or, if you know that the bus is faster, write `accept_over_budget: true` under "
             "`modbus_tcp`");
}

}  // namespace

bool board_vents_when_silent(const Context& context) {
  if (const auto* simulated = std::get_if<drivers::SimulatedBoardSettings>(&context.rig.board)) {
    return simulated->watchdog_timeout_s > 0;
  }
  return context.map && vents(context, context.map->watchdog);
}

void check_whole(Context& context, MapReader& top) {
  context.rig.wiring = context.wiring;
  if (auto* const modbus = std::get_if<drivers::ModbusTcpSettings>(&context.rig.board)) {
    modbus->wiring = context.wiring;
    for (std::string& sentence : drivers::wiring_problems(modbus->map, modbus->wiring)) {
      top.report("channels", std::move(sentence));
    }
  }
  check_watchdog(context, top);
  check_watchdog_time(context, top);
  for (std::string& sentence : control::settings_problems(context.rig.settings)) {
    top.report("channels", std::move(sentence));
  }
  check_budget(context, top);
}

}  // namespace softgrip::daemon::rig_file
