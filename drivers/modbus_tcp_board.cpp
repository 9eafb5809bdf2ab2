#include "drivers/modbus_tcp_board.h"

#include <modbus/modbus.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "drivers/big_endian.h"
#include "drivers/clock.h"
#include "drivers/exchange_plan.h"
#include "drivers/judged_input.h"
#include "drivers/modbus_session.h"
#include "drivers/read_back_history.h"
#include "drivers/registers.h"
#include "drivers/round_trip.h"

namespace softgrip::drivers {
namespace {

Nanoseconds now() noexcept {
  return MonotonicClock().now();
}

}  // namespace

struct ModbusTcpBoard::Parts {
  explicit Parts(const ModbusTcpSettings& given)
      : settings(given),
        plan(plan_exchange(settings.map, settings.wiring)),
        session(settings.host, settings.port, settings.unit),
        output_words(plan.output_words),
        requested_raws(settings.wiring.size()),
        accepted(settings.map.read_back.has_value() ? *settings.map.read_back : ReadBack{},
                 settings.wiring.size()),
        scratch(settings.wiring.size()) {
    for (const ReadStep& read : plan.reads) replies.emplace_back(read.count);
  }

  ModbusTcpSettings settings;
  ExchangePlan plan;
  ModbusSession session;
  RoundTrip round_trip;
  std::vector<std::uint16_t> output_words;
  std::vector<double> requested_raws;  ///< what each output was told, after rounding and clamping
  ReadBackHistory accepted;
  std::vector<std::vector<std::uint16_t>> replies;  ///< one per read of the plan; bits as 0 or 1
  std::vector<Reading> scratch;                     ///< so that readings change all at once or not at all
  bool clear_due = false;                           ///< a session is new: a tripped watchdog may be cleared
  std::array<char, 200> own_detail{};
  const char* detail = "";

  BusStatus fail(BusStatus status, const char* format, std::size_t channel, double value) noexcept {
    std::snprintf(own_detail.data(), own_detail.size(), format, settings.wiring[channel].name.c_str(), value);
    detail = own_detail.data();
    return status;
  }
  BusStatus say(BusStatus status, const char* text) noexcept {
    detail = text;
    return status;
  }

  BusStatus ask(const ModbusRequest& request, Nanoseconds deadline) noexcept;
  BusStatus write_fixed(const FixedWrite& write, Nanoseconds deadline) noexcept;
  BusStatus write_outputs(Nanoseconds deadline, Nanoseconds& sampled_at) noexcept;
  BusStatus read(std::size_t step, Nanoseconds deadline) noexcept;
  void take_reply(std::size_t step) noexcept;
  BusStatus clear_watchdog(Nanoseconds deadline, Nanoseconds& sampled_at) noexcept;
  BusStatus transact_all(Nanoseconds deadline, Nanoseconds& sampled_at) noexcept;
  BusStatus probe(Nanoseconds deadline) noexcept;

  BusStatus encode_outputs(std::span<const double> commands_kpa) noexcept;
  BusStatus check_outputs() noexcept;
  [[nodiscard]] bool is_tripped() const noexcept;
  [[nodiscard]] double raw_at(const Slot& slot, RegisterKind kind) const noexcept;
  [[nodiscard]] JudgedInput input(const InputWiring& wiring, const Slot& slot,
                                  const std::optional<Slot>& status) const noexcept;
  void make_reading(std::size_t channel, Nanoseconds sampled_at, Reading& reading) const noexcept;
};

BusStatus ModbusTcpBoard::Parts::ask(const ModbusRequest& request, Nanoseconds deadline) noexcept {
  const BusStatus status = session.ask(request, deadline);
  if (status == BusStatus::ok) return status;
  return say(status, session.detail());
}

BusStatus ModbusTcpBoard::Parts::write_fixed(const FixedWrite& write, Nanoseconds deadline) noexcept {
  return ask({.function = write.function, .address = write.address, .values = {&write.value, 1}}, deadline);
}

void ModbusTcpBoard::Parts::take_reply(std::size_t step) noexcept {
  const std::span<const std::uint8_t> data = session.data();
  std::vector<std::uint16_t>& words = replies[step];
  const bool bits = plan.reads[step].function <= MODBUS_FC_READ_DISCRETE_INPUTS;
  for (std::size_t i = 0; i < words.size(); ++i) {
    words[i] = bits ? static_cast<std::uint16_t>(data[i / 8] >> (i % 8) & 1) : word_at(data, 2 * i);
  }
}

BusStatus ModbusTcpBoard::Parts::read(std::size_t step, Nanoseconds deadline) noexcept {
  const ReadStep& read = plan.reads[step];
  const BusStatus status =
      ask({.function = read.function, .address = read.address, .count = read.count}, deadline);
  if (status == BusStatus::ok) take_reply(step);
  return status;
}

BusStatus ModbusTcpBoard::Parts::write_outputs(Nanoseconds deadline, Nanoseconds& sampled_at) noexcept {
  for (std::size_t i = 0; i < plan.writes.size(); ++i) {
    const WriteStep& write = plan.writes[i];
    const auto values = std::span<const std::uint16_t>(output_words).subspan(write.first_word, write.count);
    if (i == 0 && plan.combined_read.has_value()) {
      const ReadStep& read = plan.reads[*plan.combined_read];
      sampled_at = now();
      const BusStatus status = ask({.function = MODBUS_FC_WRITE_AND_READ_REGISTERS,
                                    .address = read.address,
                                    .count = read.count,
                                    .write_address = write.address,
                                    .values = values},
                                   deadline);
      if (status != BusStatus::ok) return status;
      take_reply(*plan.combined_read);
      continue;
    }
    const BusStatus status =
        ask({.function = write.function, .address = write.address, .values = values}, deadline);
    if (status != BusStatus::ok) return status;
  }
  return BusStatus::ok;
}

/// After a new session only: the commands of this exchange stand in the board already, so that what it
/// returns to when the tripped state ends is, on boards that take writes while tripped, what was asked for.
/// On those that ignore them the second write follows at once.
BusStatus ModbusTcpBoard::Parts::clear_watchdog(Nanoseconds deadline, Nanoseconds& sampled_at) noexcept {
  if (!clear_due || !settings.map.watchdog.clear.has_value()) return BusStatus::ok;
  if (plan.tripped.has_value()) {
    if (const BusStatus status = read(plan.tripped->step, deadline); status != BusStatus::ok) return status;
    if (!is_tripped()) {
      clear_due = false;
      return BusStatus::ok;
    }
  }
  if (const BusStatus status = write_fixed(*settings.map.watchdog.clear, deadline); status != BusStatus::ok) {
    return status;
  }
  clear_due = false;
  return write_outputs(deadline, sampled_at);
}

BusStatus ModbusTcpBoard::Parts::transact_all(Nanoseconds deadline, Nanoseconds& sampled_at) noexcept {
  if (const BusStatus status = write_outputs(deadline, sampled_at); status != BusStatus::ok) return status;
  if (const BusStatus status = clear_watchdog(deadline, sampled_at); status != BusStatus::ok) return status;
  if (settings.map.watchdog.feed_write.has_value()) {
    const BusStatus status = write_fixed(*settings.map.watchdog.feed_write, deadline);
    if (status != BusStatus::ok) return status;
  }
  for (std::size_t step = 0; step < plan.reads.size(); ++step) {
    if (plan.combined_read == step) continue;
    if (step == plan.sampling_read) sampled_at = now();
    if (const BusStatus status = read(step, deadline); status != BusStatus::ok) return status;
  }
  return BusStatus::ok;
}

BusStatus ModbusTcpBoard::Parts::encode_outputs(std::span<const double> commands_kpa) noexcept {
  const TerminalBlock& outputs = settings.map.outputs;
  const RegisterKind kind = outputs.registers.kind;
  BusStatus status = BusStatus::ok;
  for (std::size_t i = 0; i < commands_kpa.size(); ++i) {
    if (!std::isfinite(commands_kpa[i])) {
      return fail(BusStatus::write_refused, "channel '%s': a command that is no number was not written", i,
                  commands_kpa[i]);
    }
    const double electrical = settings.wiring[i].valve.scaling.x_at(commands_kpa[i]);
    double raw = outputs.scaling.x_at(electrical);
    if (kind != RegisterKind::float32) raw = std::round(raw);
    requested_raws[i] = std::clamp(raw, outputs.raw_min, outputs.raw_max);
    if (requested_raws[i] != raw) {
      status =
          fail(BusStatus::write_refused,
               "channel '%s': %g kPa is beyond the output's range, its end was written", i, commands_kpa[i]);
    }
    encode(requested_raws[i], kind, settings.map.word_order,
           std::span<std::uint16_t>(output_words).subspan(plan.channels[i].output_word, words_of(kind)));
  }
  return status;
}

bool ModbusTcpBoard::Parts::is_tripped() const noexcept {
  if (!plan.tripped.has_value()) return false;
  const std::uint16_t word = replies[plan.tripped->step][plan.tripped->offset];
  return (word & settings.map.watchdog.tripped->mask) != 0;
}

double ModbusTcpBoard::Parts::raw_at(const Slot& slot, RegisterKind kind) const noexcept {
  const auto words = std::span<const std::uint16_t>(replies[slot.step]).subspan(slot.offset, words_of(kind));
  return decode(words, kind, settings.map.word_order);
}

BusStatus ModbusTcpBoard::Parts::check_outputs() noexcept {
  if (is_tripped()) {
    return say(BusStatus::watchdog_tripped,
               "the board's watchdog tripped: its outputs are at their safe value");
  }
  if (!settings.map.read_back.has_value()) return BusStatus::ok;
  accepted.note(requested_raws);
  const RegisterKind kind = settings.map.read_back->registers.kind;
  for (std::size_t i = 0; i < requested_raws.size(); ++i) {
    const double raw = raw_at(*plan.channels[i].read_back, kind);
    if (!accepted.accepts(i, raw)) {
      return fail(BusStatus::write_refused, "channel '%s': the output reads back as raw %g", i, raw);
    }
  }
  return BusStatus::ok;
}

JudgedInput ModbusTcpBoard::Parts::input(const InputWiring& wiring, const Slot& slot,
                                         const std::optional<Slot>& status) const noexcept {
  std::optional<std::uint16_t> status_word;
  if (status.has_value()) status_word = replies[status->step][status->offset];
  return judge(settings.map, wiring, raw_at(slot, settings.map.inputs.registers.kind), status_word);
}

void ModbusTcpBoard::Parts::make_reading(std::size_t channel, Nanoseconds sampled_at,
                                         Reading& reading) const noexcept {
  const ChannelWiring& wiring = settings.wiring[channel];
  const ChannelSlots& slots = plan.channels[channel];
  const JudgedInput displacement = input(wiring.displacement, slots.displacement, slots.displacement_status);
  // Without a value the last one stays, marked invalid: NaN in a displacement helps nobody downstream.
  if (std::isfinite(displacement.physical)) reading.displacement_mm = displacement.physical;
  reading.validity = displacement.validity;
  reading.pressure_kpa = std::numeric_limits<double>::quiet_NaN();
  if (wiring.pressure.has_value()) {
    const JudgedInput pressure = input(*wiring.pressure, *slots.pressure, slots.pressure_status);
    if (pressure.validity == model::Validity::valid) reading.pressure_kpa = pressure.physical;
  }
  reading.command_readback_kpa = std::numeric_limits<double>::quiet_NaN();
  if (slots.read_back.has_value()) {
    const double raw = raw_at(*slots.read_back, settings.map.read_back->registers.kind);
    reading.command_readback_kpa = wiring.valve.scaling.y_at(settings.map.outputs.scaling.y_at(raw));
  }
  reading.sampled_at = sampled_at;
  ++reading.sequence;
}

BusStatus ModbusTcpBoard::Parts::probe(Nanoseconds deadline) noexcept {
  round_trip.reset();
  const Nanoseconds start = now();
  const Nanoseconds enough = start + (deadline - start) / 4;
  for (int i = 0; i < settings.probes; ++i) {
    const Nanoseconds before = now();
    if (i > 0 && before > enough) break;
    if (const BusStatus status = read(plan.sampling_read, deadline); status != BusStatus::ok) return status;
    round_trip.add(now() - before);
  }
  return BusStatus::ok;
}

ModbusTcpBoard::ModbusTcpBoard(const ModbusTcpSettings& settings)
    : parts_(std::make_unique<Parts>(settings)) {}

ModbusTcpBoard::~ModbusTcpBoard() = default;

std::size_t ModbusTcpBoard::channels() const noexcept {
  return parts_->settings.wiring.size();
}

BusStatus ModbusTcpBoard::connect(std::chrono::nanoseconds deadline) noexcept {
  Parts& parts = *parts_;
  const Nanoseconds until = now() + deadline.count();
  if (const BusStatus status = parts.session.open(until); status != BusStatus::ok) {
    return parts.say(status, parts.session.detail());
  }
  const auto abandon = [&parts](BusStatus status) {
    parts.session.close();
    return status;
  };
  for (const FixedWrite& write : parts.settings.map.setup) {
    if (const BusStatus status = parts.write_fixed(write, until); status != BusStatus::ok) {
      return abandon(status);
    }
  }
  // Measured once. Later sessions begin with the outputs: questions that go before them would feed the
  // board's watchdog while it still has the pressure of the moment in which the line failed.
  if (parts.round_trip.count() == 0) {
    if (const BusStatus status = parts.probe(until); status != BusStatus::ok) return abandon(status);
  }
  parts.clear_due = true;
  parts.accepted.forget();
  return BusStatus::ok;
}

BusStatus ModbusTcpBoard::exchange(std::span<const double> commands_kpa, std::span<Reading> readings,
                                   std::chrono::nanoseconds deadline) noexcept {
  Parts& parts = *parts_;
  const Nanoseconds until = now() + deadline.count();
  if (commands_kpa.size() != channels() || readings.size() != channels()) {
    return parts.say(BusStatus::write_refused, "not one command and one reading per channel");
  }
  if (!parts.session.is_open()) {
    // What ended the session stays the detail: it is the better answer to "why".
    return BusStatus::disconnected;
  }
  const BusStatus encoded = parts.encode_outputs(commands_kpa);
  for (const double command : commands_kpa) {
    if (!std::isfinite(command)) return encoded;
  }
  Nanoseconds sampled_at = 0;
  if (const BusStatus status = parts.transact_all(until, sampled_at); status != BusStatus::ok) return status;
  if (const BusStatus status = parts.check_outputs(); status != BusStatus::ok) return status;
  if (encoded != BusStatus::ok) return encoded;
  for (std::size_t i = 0; i < readings.size(); ++i) parts.make_reading(i, sampled_at, readings[i]);
  return BusStatus::ok;
}

const char* ModbusTcpBoard::detail() const noexcept {
  return parts_->detail;
}

std::string ModbusTcpBoard::describe() const {
  const ModbusTcpSettings& settings = parts_->settings;
  return settings.map.name + " at " + settings.host + ":" + std::to_string(settings.port) + " unit " +
         std::to_string(settings.unit);
}

Board::Budget ModbusTcpBoard::budget() const {
  const Parts& parts = *parts_;
  const std::size_t feeding = parts.settings.map.watchdog.feed_write.has_value() ? 1 : 0;
  const std::string plan =
      drivers::describe(parts.plan) + (feeding != 0 ? ", one write feeds the watchdog" : "");
  return tcp_budget(parts.plan.transactions() + feeding, plan, parts.settings.host, parts.round_trip);
}

bool ModbusTcpBoard::has_watchdog() const noexcept {
  return parts_->settings.map.watchdog.kind != BoardWatchdog::Kind::none;
}

}  // namespace softgrip::drivers
