#include "drivers/modbus/modbus_board.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "base/clock.h"
#include "drivers/board/round_trip.h"

namespace softgrip::drivers {
namespace {

bool ends_a_session(BusStatus status) noexcept {
  return status == BusStatus::disconnected || status == BusStatus::closed_at_once ||
         status == BusStatus::timed_out || status == BusStatus::bad_reply;
}

/// Selects the links and modules for a step of connect(): those with outputs, or those without outputs.
enum class Outputs { some, none };

/// Returns the time at which the fraction 1/`divisor` of the time until the deadline is over.
Nanoseconds fraction_until(Nanoseconds deadline, Nanoseconds divisor) noexcept {
  const Nanoseconds now = monotonic_now();
  return now + (deadline - now) / divisor;
}

}  // namespace

struct ModbusBoard::Parts {
  explicit Parts(const ModbusSettings& given) : settings(given) {
    for (const ModbusAddress& address : settings.links) links.push_back(make_link(address));
    modules.reserve(settings.modules.size());
    for (std::size_t i = 0; i < settings.modules.size(); ++i) {
      const ModbusModuleSettings& module = settings.modules[i];
      modules.emplace_back(module, i, settings.wiring, *links[module.link]);
    }
  }

  ModbusSettings settings;
  std::vector<std::unique_ptr<ModbusLink>> links;
  std::vector<ModbusModule> modules;
  bool measured = false;
  std::array<char, 256> detail{};

  void close() noexcept {
    for (const auto& link : links) link->close();
  }
  [[nodiscard]] bool drives_outputs(std::size_t link) const noexcept {
    return std::any_of(modules.begin(), modules.end(), [link](const ModbusModule& module) {
      return module.settings().link == link && module.drives_outputs();
    });
  }
  /// Returns true if every link to a module with outputs is open.
  [[nodiscard]] bool is_open() const noexcept {
    for (std::size_t link = 0; link < links.size(); ++link) {
      if (drives_outputs(link) && !links[link]->is_open()) return false;
    }
    return true;
  }
  BusStatus say(BusStatus status, const char* text) noexcept {
    std::snprintf(detail.data(), detail.size(), "%s", text);
    return status;
  }
  /// Stores the reason for a failure. If the board has several modules, the reason contains the name of the
  /// module. If the failure ends the session, all links are closed.
  BusStatus failed(BusStatus status, const ModbusModule& module) noexcept {
    if (modules.size() == 1) {
      say(status, module.detail());
    } else {
      std::snprintf(detail.data(), detail.size(), "module '%s': %s", module.settings().name.c_str(),
                    module.detail());
    }
    if (ends_a_session(status)) close();
    return status;
  }

  BusStatus open(Nanoseconds deadline) noexcept;
  BusStatus each_link(BusStatus (ModbusLink::*step)(Nanoseconds) noexcept, Outputs outputs,
                      Nanoseconds deadline) noexcept;
  BusStatus each_module(BusStatus (ModbusModule::*step)(Nanoseconds) noexcept, Outputs outputs,
                        Nanoseconds deadline) noexcept;
  BusStatus prepare(Outputs outputs, Nanoseconds deadline) noexcept;
  BusStatus leave_out(ModbusModule& module, Nanoseconds deadline) noexcept;
  BusStatus encode(std::span<const double> commands_kpa) noexcept;
  BusStatus look_first(Nanoseconds deadline) noexcept;
  BusStatus transact(Nanoseconds deadline) noexcept;
  void fill(std::span<Reading> readings) const noexcept;
};

/// Opens the links and prepares the modules for a new session. A module without outputs that does not respond
/// must not prevent the writes to the other modules. Therefore, the modules with outputs are prepared first,
/// and the opening of the links without outputs takes at most a quarter of the remaining time. All links are
/// opened before the first wait for a settle time, so that the settle times of the links overlap.
///
/// A link without outputs may remain closed. With a closed link, each exchange still writes the commands, and
/// fails when it reads from the closed link.
BusStatus ModbusBoard::Parts::open(Nanoseconds deadline) noexcept {
  close();
  BusStatus status = each_link(&ModbusLink::open, Outputs::some, deadline);
  if (status != BusStatus::ok) return status;
  (void)each_link(&ModbusLink::open, Outputs::none, fraction_until(deadline, 4));
  if (!measured) {
    for (const auto& link : links) link->forget_measurements();
  }
  status = each_link(&ModbusLink::settle, Outputs::some, deadline);
  if (status == BusStatus::ok) status = prepare(Outputs::some, deadline);
  if (status != BusStatus::ok) return status;
  (void)each_link(&ModbusLink::settle, Outputs::none, deadline);
  status = prepare(Outputs::none, deadline);
  measured = true;
  return status;
}

/// Opens or settles the links. Returns the status of the first link with outputs that failed.
BusStatus ModbusBoard::Parts::each_link(BusStatus (ModbusLink::*step)(Nanoseconds) noexcept, Outputs outputs,
                                        Nanoseconds deadline) noexcept {
  for (std::size_t link = 0; link < links.size(); ++link) {
    if (drives_outputs(link) != (outputs == Outputs::some)) continue;
    if (step == &ModbusLink::settle && !links[link]->is_open()) continue;
    const BusStatus status = (links[link].get()->*step)(deadline);
    if (status == BusStatus::ok) continue;
    say(status, links[link]->detail());
    if (outputs == Outputs::some) return status;
  }
  return BusStatus::ok;
}

/// Sends the setup or the probe of the modules. A step of a module without outputs takes at most half of the
/// remaining time. If the step fails, the module is left out of the session.
BusStatus ModbusBoard::Parts::each_module(BusStatus (ModbusModule::*step)(Nanoseconds) noexcept,
                                          Outputs outputs, Nanoseconds deadline) noexcept {
  const bool drives = outputs == Outputs::some;
  for (ModbusModule& module : modules) {
    if (module.drives_outputs() != drives || !links[module.settings().link]->is_open()) continue;
    BusStatus status = (module.*step)(drives ? deadline : fraction_until(deadline, 2));
    if (status == BusStatus::ok) continue;
    if (drives) return failed(status, module);
    status = leave_out(module, deadline);
    if (status != BusStatus::ok) return status;
  }
  return BusStatus::ok;
}

/// Writes the setup of the modules. In the first session, also measures the round trips. A later session must
/// begin with a write of the outputs. Any other request would feed the board's watchdog while the outputs
/// have the values of the previous session.
BusStatus ModbusBoard::Parts::prepare(Outputs outputs, Nanoseconds deadline) noexcept {
  BusStatus status = each_module(&ModbusModule::set_up, outputs, deadline);
  if (measured) return status;
  const Nanoseconds enough = fraction_until(deadline, 4);
  for (int i = 0; i < settings.probes && status == BusStatus::ok; ++i) {
    if (i > 0 && monotonic_now() > enough) break;
    status = each_module(&ModbusModule::probe, outputs, deadline);
  }
  return status;
}

/// Leaves a module without outputs out of the session, after it has failed. If the link also leads to
/// outputs, the link is opened again, and the modules with outputs on this link are set up again.
BusStatus ModbusBoard::Parts::leave_out(ModbusModule& module, Nanoseconds deadline) noexcept {
  module.leave_out();
  const std::size_t at = module.settings().link;
  ModbusLink& link = *links[at];
  if (!drives_outputs(at)) link.close();
  if (!drives_outputs(at) || link.is_open()) return BusStatus::ok;
  BusStatus status = link.open(deadline);
  if (status == BusStatus::ok) status = link.settle(deadline);
  if (status != BusStatus::ok) return say(status, link.detail());
  for (ModbusModule& other : modules) {
    if (other.settings().link != at || !other.drives_outputs()) continue;
    status = other.set_up(deadline);
    if (status != BusStatus::ok) return failed(status, other);
  }
  return BusStatus::ok;
}

BusStatus ModbusBoard::Parts::encode(std::span<const double> commands_kpa) noexcept {
  BusStatus result = BusStatus::ok;
  for (ModbusModule& module : modules) {
    const BusStatus status = module.encode(commands_kpa);
    if (status != BusStatus::ok) result = failed(status, module);
  }
  return result;
}

/// Reads and checks the modules that this exchange must read before it writes them.
BusStatus ModbusBoard::Parts::look_first(Nanoseconds deadline) noexcept {
  for (ModbusModule& module : modules) {
    module.begin_exchange();
    if (!module.reads_first()) continue;
    BusStatus status = module.read(deadline);
    if (status == BusStatus::ok) status = module.check();
    if (status != BusStatus::ok) return failed(status, module);
  }
  return BusStatus::ok;
}

BusStatus ModbusBoard::Parts::transact(Nanoseconds deadline) noexcept {
  if (const BusStatus status = look_first(deadline); status != BusStatus::ok) return status;
  for (ModbusModule& module : modules) {
    if (const BusStatus status = module.write(deadline); status != BusStatus::ok) {
      return failed(status, module);
    }
  }
  for (ModbusModule& module : modules) {
    if (module.reads_first()) continue;
    if (const BusStatus status = module.read(deadline); status != BusStatus::ok) {
      return failed(status, module);
    }
  }
  BusStatus result = BusStatus::ok;
  for (ModbusModule& module : modules) {
    if (module.reads_first()) continue;
    const BusStatus status = module.check();
    if (status != BusStatus::ok && result == BusStatus::ok) result = failed(status, module);
  }
  return result;
}

void ModbusBoard::Parts::fill(std::span<Reading> readings) const noexcept {
  for (std::size_t i = 0; i < readings.size(); ++i) {
    readings[i].pressure_kpa = std::numeric_limits<double>::quiet_NaN();
    readings[i].temperature_c = std::numeric_limits<double>::quiet_NaN();
    readings[i].command_readback_kpa = std::numeric_limits<double>::quiet_NaN();
    for (const ModbusModule& module : modules) module.fill(i, readings[i]);
    ++readings[i].sequence;
  }
}

std::vector<std::string> problems_of(const ModbusSettings& settings) {
  std::vector<ModuleTerminals> modules;
  for (const ModbusModuleSettings& module : settings.modules) {
    modules.push_back(terminals_of(module.map));
    if (settings.modules.size() > 1) modules.back().name = module.name;
  }
  return wiring_problems(modules, settings.wiring);
}

ModbusBoard::ModbusBoard(const ModbusSettings& settings) : parts_(std::make_unique<Parts>(settings)) {}

ModbusBoard::~ModbusBoard() = default;

std::size_t ModbusBoard::channels() const noexcept {
  return parts_->settings.wiring.size();
}

BusStatus ModbusBoard::connect(std::chrono::nanoseconds deadline) noexcept {
  const BusStatus status = parts_->open(monotonic_now() + deadline.count());
  if (status != BusStatus::ok) parts_->close();
  return status;
}

BusStatus ModbusBoard::exchange(std::span<const double> commands_kpa, std::span<Reading> readings,
                                std::chrono::nanoseconds deadline) noexcept {
  Parts& parts = *parts_;
  const Nanoseconds until = monotonic_now() + deadline.count();
  for (ModbusModule& module : parts.modules) module.forget_found();
  if (commands_kpa.size() != channels() || readings.size() != channels()) {
    return parts.say(BusStatus::write_refused,
                     "the numbers of commands, readings and channels are not equal");
  }
  // detail() keeps the reason for the end of the session, because this reason is more useful than
  // "disconnected".
  if (!parts.is_open()) return BusStatus::disconnected;
  for (std::size_t i = 0; i < commands_kpa.size(); ++i) {
    if (std::isfinite(commands_kpa[i])) continue;
    std::snprintf(parts.detail.data(), parts.detail.size(),
                  "channel '%s': a command that is not a number was not written",
                  parts.settings.wiring[i].name.c_str());
    return BusStatus::write_refused;
  }
  const BusStatus encoded = parts.encode(commands_kpa);
  if (const BusStatus status = parts.transact(until); status != BusStatus::ok) return status;
  if (encoded != BusStatus::ok) return encoded;
  parts.fill(readings);
  return BusStatus::ok;
}

const char* ModbusBoard::detail() const noexcept {
  return parts_->detail.data();
}

double ModbusBoard::found_kpa(std::size_t channel) const noexcept {
  return parts_->modules[parts_->settings.wiring[channel].valve.module].found_kpa(channel);
}

std::string ModbusBoard::describe() const {
  std::string text;
  for (const ModbusModule& module : parts_->modules) {
    const ModbusModuleSettings& settings = module.settings();
    if (!text.empty()) text += "; ";
    text += settings.map.name + " at " + parts_->links[settings.link]->describe() + " unit " +
            std::to_string(settings.unit);
  }
  return text;
}

Board::Budget ModbusBoard::budget() const {
  std::vector<Budget> costs;
  for (std::size_t link = 0; link < parts_->links.size(); ++link) {
    std::vector<TransactionSize> transactions;
    std::string plan;
    for (const ModbusModule& module : parts_->modules) {
      if (module.settings().link != link) continue;
      const std::vector<TransactionSize> more = module.transactions();
      transactions.insert(transactions.end(), more.begin(), more.end());
      if (!plan.empty()) plan += "; ";
      if (parts_->modules.size() > 1) plan += module.settings().name + ": ";
      plan += drivers::describe(module.plan());
      if (module.drives_outputs() && module.settings().map.watchdog.feed_write.has_value()) {
        plan += ", one write resets the watchdog";
      }
    }
    costs.push_back(parts_->links[link]->cost(transactions, plan));
  }
  return sum_of(costs);
}

bool ModbusBoard::has_watchdog() const noexcept {
  return std::all_of(parts_->modules.begin(), parts_->modules.end(), [](const ModbusModule& module) {
    return !module.drives_outputs() || module.settings().map.watchdog.kind != BoardWatchdog::Kind::none;
  });
}

std::chrono::nanoseconds ModbusBoard::watchdog_time() const noexcept {
  double first_s = 0;
  for (const ModbusModule& module : parts_->modules) {
    const BoardWatchdog& watchdog = module.settings().map.watchdog;
    if (!module.drives_outputs() || watchdog.kind == BoardWatchdog::Kind::none) continue;
    first_s = first_s > 0 ? std::min(first_s, watchdog.timeout_s) : watchdog.timeout_s;
  }
  return std::chrono::nanoseconds(nanoseconds(first_s));
}

bool ModbusBoard::fed_by_readers() const noexcept {
  return std::any_of(parts_->modules.begin(), parts_->modules.end(), [](const ModbusModule& module) {
    return module.drives_outputs() && module.settings().map.watchdog.fed_by_reading();
  });
}

unsigned ModbusBoard::clients() const noexcept {
  unsigned most = 0;
  for (const ModbusModule& module : parts_->modules) most = std::max(most, module.clients());
  return most;
}

}  // namespace softgrip::drivers
