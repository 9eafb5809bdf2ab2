#include "drivers/modbus/modbus_module.h"

#include <modbus/modbus.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "base/clock.h"

namespace softgrip::drivers {
namespace {

/// Every 8th exchange reads the outputs before it writes them; see ModbusModule::begin_exchange().
constexpr std::uint32_t reads_first_every = 8;

ModbusRequest request_of(const FixedWrite& write) noexcept {
  return {.function = write.function, .address = write.address, .values = {&write.value, 1}};
}

}  // namespace

ModbusModule::ModbusModule(ModbusModuleSettings settings, std::size_t index,
                           const std::vector<ChannelWiring>& wiring, ModbusLink& link)
    : settings_(std::move(settings)),
      wiring_(wiring),
      plan_(plan_exchange(settings_.map, wiring, index)),
      link_(link),
      output_words_(plan_.output_words),
      requested_raws_(wiring.size()),
      accepted_(settings_.map.read_back.has_value() ? *settings_.map.read_back : ReadBack{}, wiring.size()),
      found_kpa_(wiring.size(), std::numeric_limits<double>::quiet_NaN()) {
  for (const ReadStep& step : plan_.reads) replies_.emplace_back(step.count);
}

BusStatus ModbusModule::fail(BusStatus status, const char* format, std::size_t channel,
                             double value) noexcept {
  std::snprintf(own_detail_.data(), own_detail_.size(), format, wiring_[channel].name.c_str(), value);
  detail_ = own_detail_.data();
  return status;
}

BusStatus ModbusModule::say(BusStatus status, const char* text) noexcept {
  detail_ = text;
  return status;
}

BusStatus ModbusModule::ask(const ModbusRequest& request, Nanoseconds deadline) noexcept {
  const BusStatus status = link_.ask(settings_.unit, request, deadline);
  if (status == BusStatus::ok) return status;
  return say(status, link_.detail());
}

BusStatus ModbusModule::write_fixed(std::span<const FixedWrite> writes, Nanoseconds deadline) noexcept {
  for (const FixedWrite& write : writes) {
    if (const BusStatus status = ask(drivers::request_of(write), deadline); status != BusStatus::ok) {
      return status;
    }
  }
  return BusStatus::ok;
}

ModbusRequest ModbusModule::request_of(const ReadStep& step) const noexcept {
  return {.function = step.function, .address = step.address, .count = step.count};
}

ModbusRequest ModbusModule::request_of(std::size_t write, bool combined) const noexcept {
  const WriteStep& step = plan_.writes[write];
  const auto values = std::span<const std::uint16_t>(output_words_).subspan(step.first_word, step.count);
  if (!combined) {
    return {.function = step.function, .address = step.address, .values = values};
  }
  const ReadStep& read = plan_.reads[*plan_.combined_read];
  return {.function = MODBUS_FC_WRITE_AND_READ_REGISTERS,
          .address = read.address,
          .count = read.count,
          .write_address = step.address,
          .values = values};
}

void ModbusModule::take_reply(std::size_t step) noexcept {
  const std::span<const std::uint8_t> data = link_.data();
  std::vector<std::uint16_t>& words = replies_[step];
  const bool bits = plan_.reads[step].function <= MODBUS_FC_READ_DISCRETE_INPUTS;
  for (std::size_t i = 0; i < words.size(); ++i) {
    words[i] = bits ? static_cast<std::uint16_t>(data[i / 8] >> (i % 8) & 1) : word_at(data, 2 * i);
  }
}

BusStatus ModbusModule::read_step(std::size_t step, Nanoseconds deadline) noexcept {
  const BusStatus status = ask(request_of(plan_.reads[step]), deadline);
  if (status == BusStatus::ok) take_reply(step);
  return status;
}

BusStatus ModbusModule::write_outputs(Nanoseconds deadline) noexcept {
  for (std::size_t i = 0; i < plan_.writes.size(); ++i) {
    const bool combined = i == 0 && combines();
    if (combined) sampled_at_ = monotonic_now();
    if (const BusStatus status = ask(request_of(i, combined), deadline); status != BusStatus::ok)
      return status;
    if (combined) take_reply(*plan_.combined_read);
  }
  return BusStatus::ok;
}

/// Returns the status of a failed write. While the watchdog of a board holds the outputs, the board may
/// respond to writes with an exception. In this case, the status is `watchdog_tripped`.
BusStatus ModbusModule::name_refusal(BusStatus status, Nanoseconds deadline) noexcept {
  if (status != BusStatus::exception || !plan_.tripped.has_value()) return status;
  const char* const refusal = detail_;
  if (read_step(plan_.tripped->step, deadline) == BusStatus::ok && is_tripped()) {
    return say(BusStatus::watchdog_tripped,
               "the board's watchdog tripped, so the board rejects writes while the outputs are at their "
               "safe values");
  }
  return say(status, refusal);
}

/// Writes the outputs for the first time in a session, and clears a tripped watchdog. The commands are
/// written before the watchdog is cleared. As a result, a board that accepts this write continues with the
/// present commands. Some boards ignore or refuse writes while the watchdog is tripped. Therefore, a second
/// write follows directly after the watchdog was cleared.
BusStatus ModbusModule::first_write(Nanoseconds deadline) noexcept {
  const BusStatus written = write_outputs(deadline);
  if (written != BusStatus::ok && written != BusStatus::exception) return written;
  if (plan_.tripped.has_value()) {
    const char* const refusal = detail_;
    const BusStatus status = read_step(plan_.tripped->step, deadline);
    if (status != BusStatus::ok) return status;
    if (!is_tripped()) {
      clear_due_ = false;
      return say(written, refusal);
    }
  } else if (written != BusStatus::ok) {
    return written;
  }
  const BoardWatchdog& watchdog = settings_.map.watchdog;
  if (const BusStatus status = write_fixed(watchdog.clear, deadline); status != BusStatus::ok) return status;
  if (setup_due_) {
    const BusStatus status = write_fixed(settings_.map.setup, deadline);
    if (status != BusStatus::ok) return status;
  }
  clear_due_ = false;
  setup_due_ = false;
  return write_outputs(deadline);
}

BusStatus ModbusModule::set_up(Nanoseconds deadline) noexcept {
  clear_due_ = drives_outputs() && !settings_.map.watchdog.clear.empty();
  setup_due_ = false;
  unlooked_ = 0;
  confirmed_ = false;
  reads_first_ = false;
  left_out_ = false;
  accepted_.forget();
  if (settings_.map.setup.empty()) return BusStatus::ok;
  if (clear_due_ && plan_.tripped.has_value()) {
    // If the watchdog has tripped, the setup is delayed. Otherwise, a write of the setup could end the
    // tripped state, and the outputs would return to their last values.
    const BusStatus status = read_step(plan_.tripped->step, deadline);
    if (status != BusStatus::ok) return status;
    setup_due_ = is_tripped();
  }
  return setup_due_ ? BusStatus::ok : write_fixed(settings_.map.setup, deadline);
}

BusStatus ModbusModule::probe(Nanoseconds deadline) noexcept {
  if (left_out_ || plan_.reads.empty()) return BusStatus::ok;
  const BusStatus status = read_step(plan_.sampling_read, deadline);
  if (status == BusStatus::ok) link_.keep_measurement();
  return status;
}

void ModbusModule::leave_out() noexcept {
  left_out_ = true;
  // The link can overwrite its text before the next read() of this module.
  std::snprintf(own_detail_.data(), own_detail_.size(), "%s", detail_);
}

BusStatus ModbusModule::encode(std::span<const double> commands_kpa) noexcept {
  const TerminalBlock& outputs = settings_.map.outputs;
  const RegisterKind kind = outputs.registers.kind;
  // The scaling of a float can exceed the range by a rounding error. Other kinds are rounded to integers.
  const double rounding = kind == RegisterKind::float32 ? 1e-9 * (outputs.raw_max - outputs.raw_min) : 0;
  BusStatus status = BusStatus::ok;
  for (std::size_t i = 0; i < commands_kpa.size(); ++i) {
    if (!plan_.channels[i].output_word.has_value()) continue;
    const double electrical = wiring_[i].valve.scaling.x_at(commands_kpa[i]);
    double raw = outputs.scaling.x_at(electrical);
    if (kind != RegisterKind::float32) raw = std::round(raw);
    requested_raws_[i] = std::clamp(raw, outputs.raw_min, outputs.raw_max);
    const double excess = std::abs(raw - requested_raws_[i]);
    if (kind == RegisterKind::float32) {
      // The registers contain a float, so the read-back is compared with this float.
      requested_raws_[i] = static_cast<double>(static_cast<float>(requested_raws_[i]));
    }
    if (excess > rounding) {
      status = fail(BusStatus::write_refused,
                    "channel '%s': %g kPa is outside the output's range; the limit was written", i,
                    commands_kpa[i]);
    }
    drivers::encode(
        requested_raws_[i], kind, settings_.map.word_order,
        std::span<std::uint16_t>(output_words_).subspan(*plan_.channels[i].output_word, words_of(kind)));
  }
  return status;
}

void ModbusModule::begin_exchange() noexcept {
  const bool can_tell = settings_.map.read_back.has_value() && drives_outputs() && !clear_due_;
  reads_first_ = can_tell && ++unlooked_ >= reads_first_every && confirmed_;
  if (reads_first_) unlooked_ = 0;
  confirmed_ = false;
}

BusStatus ModbusModule::write(Nanoseconds deadline) noexcept {
  const BusStatus status = clear_due_ ? first_write(deadline) : write_outputs(deadline);
  if (status != BusStatus::ok) return name_refusal(status, deadline);
  if (!drives_outputs() || !settings_.map.watchdog.feed_write.has_value()) return BusStatus::ok;
  return feed(*settings_.map.watchdog.feed_write, deadline);
}

/// Writes the value that feeds the watchdog. A heartbeat with two values changes to the other value after
/// each confirmed write.
BusStatus ModbusModule::feed(FixedWrite write, Nanoseconds deadline) noexcept {
  if (alternate_due_) write.value = write.alternate.value_or(write.value);
  const BusStatus status = write_fixed({&write, 1}, deadline);
  if (status == BusStatus::ok) alternate_due_ = !alternate_due_;
  return status;
}

BusStatus ModbusModule::read(Nanoseconds deadline) noexcept {
  if (left_out_ && link_.is_open()) return say(BusStatus::disconnected, own_detail_.data());
  for (std::size_t step = 0; step < plan_.reads.size(); ++step) {
    if (combines() && plan_.combined_read == step) continue;
    if (step == plan_.sampling_read) sampled_at_ = monotonic_now();
    if (const BusStatus status = read_step(step, deadline); status != BusStatus::ok) return status;
  }
  return BusStatus::ok;
}

bool ModbusModule::is_tripped() const noexcept {
  if (!plan_.tripped.has_value()) return false;
  const BoardWatchdog::Tripped& tripped = *settings_.map.watchdog.tripped;
  const auto words = std::span<const std::uint16_t>(replies_[plan_.tripped->step])
                         .subspan(plan_.tripped->offset, tripped.count);
  return std::any_of(words.begin(), words.end(),
                     [&](std::uint16_t word) { return (word & tripped.mask) != 0; });
}

unsigned ModbusModule::clients() const noexcept {
  return plan_.clients.has_value() ? replies_[plan_.clients->step][plan_.clients->offset] : 0;
}

double ModbusModule::raw_at(const Slot& slot, RegisterKind kind) const noexcept {
  const auto words = std::span<const std::uint16_t>(replies_[slot.step]).subspan(slot.offset, words_of(kind));
  return decode(words, kind, settings_.map.word_order);
}

double ModbusModule::read_back_kpa(std::size_t channel) const noexcept {
  const double raw = raw_at(*plan_.channels[channel].read_back, settings_.map.read_back->registers.kind);
  return wiring_[channel].valve.scaling.y_at(settings_.map.outputs.scaling.y_at(raw));
}

void ModbusModule::forget_found() noexcept {
  std::fill(found_kpa_.begin(), found_kpa_.end(), std::numeric_limits<double>::quiet_NaN());
}

BusStatus ModbusModule::check() noexcept {
  if (is_tripped()) {
    return say(BusStatus::watchdog_tripped,
               "the board's watchdog tripped, so the outputs are at their safe values");
  }
  if (!settings_.map.read_back.has_value() || !drives_outputs()) return BusStatus::ok;
  if (!reads_first_) accepted_.note(requested_raws_);
  const RegisterKind kind = settings_.map.read_back->registers.kind;
  BusStatus status = BusStatus::ok;
  for (std::size_t i = 0; i < requested_raws_.size(); ++i) {
    if (!plan_.channels[i].read_back.has_value()) continue;
    const double raw = raw_at(*plan_.channels[i].read_back, kind);
    if (accepted_.accepts(i, raw)) continue;
    if (reads_first_) {
      return fail(BusStatus::overwritten,
                  "channel '%s': another client has changed the output; its raw value was read back as %g", i,
                  raw);
    }
    found_kpa_[i] = read_back_kpa(i);
    if (status == BusStatus::ok)
      status = fail(BusStatus::write_refused,
                    "channel '%s': the raw value of the output was read back as %g, which was not written", i,
                    raw);
  }
  if (status != BusStatus::ok) return status;
  // An exchange that reads first writes the requested values after this check. Therefore, the next exchange
  // must accept these values.
  if (reads_first_) accepted_.note(requested_raws_);
  confirmed_ = !reads_first_;
  return BusStatus::ok;
}

JudgedInput ModbusModule::input(const InputWiring& wiring, const Slot& slot,
                                const std::optional<Slot>& status) const noexcept {
  std::optional<std::uint16_t> status_word;
  if (status.has_value()) status_word = replies_[status->step][status->offset];
  return judge(settings_.map, wiring, raw_at(slot, settings_.map.inputs.registers.kind), status_word);
}

void ModbusModule::fill(std::size_t channel, Reading& reading) const noexcept {
  const ChannelWiring& wiring = wiring_[channel];
  const ChannelSlots& slots = plan_.channels[channel];
  if (slots.displacement.has_value()) {
    const JudgedInput displacement =
        input(wiring.displacement, *slots.displacement, slots.displacement_status);
    // If the board delivered no value, the reading keeps the last displacement and is marked as invalid. The
    // displacement is not set to NaN, because the controller cannot process NaN.
    if (std::isfinite(displacement.physical)) reading.displacement_mm = displacement.physical;
    reading.validity = displacement.validity;
    reading.sampled_at = sampled_at_;
  }
  if (slots.pressure.has_value()) {
    const JudgedInput pressure = input(*wiring.pressure, *slots.pressure, slots.pressure_status);
    reading.pressure_kpa = pressure.validity == model::Validity::valid
                               ? pressure.physical
                               : std::numeric_limits<double>::quiet_NaN();
  }
  if (slots.temperature.has_value()) {
    const JudgedInput temperature = input(*wiring.temperature, *slots.temperature, slots.temperature_status);
    if (temperature.validity == model::Validity::valid) reading.temperature_c = temperature.physical;
  }
  if (slots.read_back.has_value()) reading.command_readback_kpa = read_back_kpa(channel);
}

std::vector<TransactionSize> ModbusModule::transactions() const {
  std::vector<TransactionSize> sizes;
  for (std::size_t i = 0; i < plan_.writes.size(); ++i) {
    sizes.push_back(size_of(request_of(i, i == 0 && plan_.combined_read.has_value())));
  }
  if (drives_outputs() && settings_.map.watchdog.feed_write.has_value()) {
    sizes.push_back(size_of(drivers::request_of(*settings_.map.watchdog.feed_write)));
  }
  for (std::size_t step = 0; step < plan_.reads.size(); ++step) {
    if (plan_.combined_read != step) sizes.push_back(size_of(request_of(plan_.reads[step])));
  }
  return sizes;
}

}  // namespace softgrip::drivers
