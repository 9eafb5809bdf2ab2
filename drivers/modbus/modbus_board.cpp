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
  BusStatus probe(Nanoseconds deadline) noexcept;
  BusStatus encode(std::span<const double> commands_kpa) noexcept;
  BusStatus look_first(Nanoseconds deadline) noexcept;
  BusStatus transact(Nanoseconds deadline) noexcept;
  void fill(std::span<Reading> readings) const noexcept;
};

/// Opens all links, and then waits until all links have settled. Therefore, the settle times of the links
/// overlap.
///
/// A link without outputs may remain closed. With a closed link, each exchange still writes the commands, and
/// fails when it reads from the closed link.
BusStatus ModbusBoard::Parts::open(Nanoseconds deadline) noexcept {
  close();
  const auto each_link = [&](BusStatus (ModbusLink::*step)(Nanoseconds) noexcept) {
    for (std::size_t link = 0; link < links.size(); ++link) {
      const BusStatus status = (links[link].get()->*step)(deadline);
      if (status == BusStatus::ok) continue;
      say(status, links[link]->detail());
      if (drives_outputs(link)) return status;
    }
    return BusStatus::ok;
  };
  if (const BusStatus status = each_link(&ModbusLink::open); status != BusStatus::ok) return status;
  if (const BusStatus status = each_link(&ModbusLink::settle); status != BusStatus::ok) return status;
  for (ModbusModule& module : modules) {
    if (!links[module.settings().link]->is_open()) continue;
    if (const BusStatus status = module.set_up(deadline); status != BusStatus::ok) {
      return failed(status, module);
    }
  }
  return measured ? BusStatus::ok : probe(deadline);
}

/// Measures the round trips only in the first session. A later session must begin with a write of the
/// outputs. Any other request would feed the board's watchdog while the outputs have the values of the
/// previous session.
BusStatus ModbusBoard::Parts::probe(Nanoseconds deadline) noexcept {
  for (const auto& link : links) link->forget_measurements();
  const Nanoseconds start = monotonic_now();
  const Nanoseconds enough = start + (deadline - start) / 4;
  for (int i = 0; i < settings.probes; ++i) {
    if (i > 0 && monotonic_now() > enough) break;
    for (ModbusModule& module : modules) {
      ModbusLink& link = *links[module.settings().link];
      if (module.plan().reads.empty() || !link.is_open()) continue;
      if (const BusStatus status = module.probe(deadline); status != BusStatus::ok) {
        return failed(status, module);
      }
      link.keep_measurement();
    }
  }
  measured = true;
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
