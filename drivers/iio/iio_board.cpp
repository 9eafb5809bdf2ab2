#include "drivers/iio/iio_board.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>

#include "base/clock.h"
#include "base/text.h"
#include "base/time.h"
#include "drivers/board/registers.h"
#include "drivers/board/round_trip.h"
#include "drivers/iio/iio_converter.h"

namespace softgrip::drivers {
namespace {

constexpr int probes = 5;

}  // namespace

struct IioBoard::Parts {
  explicit Parts(const IioSettings& given)
      : settings(given), written(given.outputs), inputs(given.inputs.size()) {
    if (given.heartbeat) written.push_back(given.heartbeat->terminal);
    outputs.resize(written.size());
  }

  IioSettings settings;
  std::vector<IioTerminal> written;  // terminals that each exchange writes: the outputs, followed by the
                                     // heartbeat
  std::vector<IioConverter> inputs;
  std::vector<IioConverter> outputs;  // one converter per terminal of `written`
  bool beats_second = false;
  bool open = false;
  RoundTrip reads;
  using Text = std::array<char, 512>;
  Text detail{};
  Text missing{};  // the first reason why a terminal cannot be used in this session; empty: all terminals can
                   // be used

  BusStatus say(BusStatus status, const std::string& what, const char* why) noexcept {
    std::snprintf(detail.data(), detail.size(), "%s: %s", what.c_str(), why);
    return status;
  }
  /// Ends the session after an error of the converter. The caller has excluded the written number as the
  /// cause of the error.
  BusStatus lost(const IioConverter& converter, int error) noexcept {
    open = false;
    return say(BusStatus::disconnected, converter.name, error != 0 ? text_of_errno(error) : "no number");
  }

  using Devices = std::vector<ComputerDevice>;
  void miss(const std::string& why) noexcept;
  [[nodiscard]] bool complete() const noexcept { return missing[0] == 0; }
  BusStatus report_missing() noexcept;
  void attach_each(const Devices& there, const std::vector<IioTerminal>& terminals, bool output,
                   std::vector<IioConverter>& converters);
  void attach_all();
  [[nodiscard]] bool uses(std::size_t output) const;
  [[nodiscard]] bool has_output() const;
  BusStatus write_raw(const IioConverter& converter, long raw) noexcept;
  BusStatus switch_on(IioConverter& converter) noexcept;
  BusStatus switch_all_on() noexcept;
  BusStatus beat() noexcept;
  void probe(Nanoseconds deadline) noexcept;
  BusStatus write(std::size_t channel, double command_kpa) noexcept;
  BusStatus write_all(std::span<const double> commands_kpa) noexcept;
  BusStatus read(const InputWiring& wiring, JudgedInput& input) noexcept;
  BusStatus read_channel(std::size_t channel, Reading& reading) noexcept;
};

/// Records the reason why a terminal cannot be used in this session.
void IioBoard::Parts::miss(const std::string& why) noexcept {
  if (complete()) std::snprintf(missing.data(), missing.size(), "%s", why.c_str());
}

/// Ends a session in which a terminal cannot be used.
BusStatus IioBoard::Parts::report_missing() noexcept {
  open = false;
  detail = missing;
  return BusStatus::disconnected;
}

/// Returns true if a channel is wired to the output. An output without a channel is not changed.
bool IioBoard::Parts::uses(std::size_t output) const {
  return output >= settings.outputs.size() ||
         std::any_of(settings.wiring.begin(), settings.wiring.end(),
                     [&](const ChannelWiring& channel) { return channel.valve.output == output; });
}

/// Returns true if at least one output of a channel can be written.
bool IioBoard::Parts::has_output() const {
  for (std::size_t i = 0; i < settings.outputs.size(); ++i) {
    if (uses(i) && outputs[i].raw.is_open()) return true;
  }
  return false;
}

void IioBoard::Parts::attach_each(const Devices& there, const std::vector<IioTerminal>& terminals,
                                  bool output, std::vector<IioConverter>& converters) {
  for (std::size_t i = 0; i < converters.size(); ++i) {
    IioConverter& converter = converters[i];
    std::string why = converter.attach(there, settings.root, terminals[i], output);
    for (std::size_t j = 0; why.empty() && j < i; ++j) {
      if (!converters[j].raw.is_open() || converters[j].path != converter.path) continue;
      why = converters[j].name + " and " + converter.name + ": both are " + converter.path;
    }
    if (why.empty()) continue;
    converter.raw.close();
    miss(why);
  }
}

/// Opens all terminals that exist. A terminal that cannot be used must not prevent the writes to the other
/// outputs.
void IioBoard::Parts::attach_all() {
  missing[0] = 0;
  const Devices there = converters_in(settings.root);
  attach_each(there, written, true, outputs);
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (!uses(i) || !outputs[i].raw.is_open()) continue;
    if (const std::string why = outputs[i].look_at_powerdown(written[i].channel); !why.empty()) miss(why);
  }
  attach_each(there, settings.inputs, false, inputs);
  if (!complete()) return;
  for (auto* const converters : {&outputs, &inputs}) {
    for (IioConverter& converter : *converters) converter.first_identity = converter.identity;
  }
}

/// Reads each input several times to measure the duration of a read, which budget() needs.
void IioBoard::Parts::probe(Nanoseconds deadline) noexcept {
  reads.reset();
  for (int i = 0; i < probes; ++i) {
    for (const IioConverter& converter : inputs) {
      const Nanoseconds before = monotonic_now();
      if (i > 0 && before > deadline) return;
      if (!converter.raw.read().has_value()) {
        lost(converter, errno);
        missing = detail;
        return;
      }
      reads.add(monotonic_now() - before);
    }
  }
}

BusStatus IioBoard::Parts::switch_on(IioConverter& converter) noexcept {
  const int error = converter.switch_on();
  if (!converter.is_off) return BusStatus::ok;
  open = false;
  return say(BusStatus::disconnected, converter.powerdown_path,
             error != 0 ? text_of_errno(error) : IioConverter::stays_off_text);
}

/// Switches on all outputs that are off. The caller must have written the numbers of all outputs, because
/// several outputs may share one powerdown attribute.
BusStatus IioBoard::Parts::switch_all_on() noexcept {
  for (IioConverter& converter : outputs) {
    if (!converter.is_off) continue;
    if (const BusStatus status = switch_on(converter); status != BusStatus::ok) return status;
  }
  return BusStatus::ok;
}

BusStatus IioBoard::Parts::write_raw(const IioConverter& converter, long raw) noexcept {
  const int error = converter.raw.write(raw);
  if (error == EINVAL || error == ERANGE) {
    return say(BusStatus::write_refused, converter.name, text_of_errno(error));
  }
  return error == 0 ? BusStatus::ok : lost(converter, error);
}

BusStatus IioBoard::Parts::beat() noexcept {
  if (!settings.heartbeat) return BusStatus::ok;
  const IioHeartbeat& heartbeat = *settings.heartbeat;
  beats_second = !beats_second;
  return write_raw(outputs.back(), beats_second ? heartbeat.second : heartbeat.first);
}

BusStatus IioBoard::Parts::write(std::size_t channel, double command_kpa) noexcept {
  const OutputWiring& valve = settings.wiring[channel].valve;
  const IioConverter& converter = outputs[valve.output];
  if (!converter.raw.is_open()) return report_missing();
  const double raw = std::round(valve.scaling.x_at(command_kpa) / converter.scale - converter.offset);
  const double taken = std::clamp(raw, 0.0, static_cast<double>(settings.outputs[valve.output].raw_max));
  const BusStatus status = write_raw(converter, static_cast<long>(taken));
  if (status != BusStatus::ok) return status;
  if (taken == raw) return BusStatus::ok;
  std::snprintf(detail.data(), detail.size(),
                "channel '%s': %g kPa is outside the output's range; the limit was written",
                settings.wiring[channel].name.c_str(), command_kpa);
  return BusStatus::write_refused;
}

/// Writes the commands of all channels, even if some of the writes fail. Returns the status of the first
/// failure. A lost output has priority over a refused write.
BusStatus IioBoard::Parts::write_all(std::span<const double> commands_kpa) noexcept {
  BusStatus result = BusStatus::ok;
  Text text{};
  for (std::size_t i = 0; i < commands_kpa.size(); ++i) {
    const BusStatus status = write(i, commands_kpa[i]);
    if (status == BusStatus::ok || result == status || result == BusStatus::disconnected) continue;
    result = status;
    text = detail;
  }
  if (result != BusStatus::ok) detail = text;
  return result;
}

BusStatus IioBoard::Parts::read(const InputWiring& wiring, JudgedInput& input) noexcept {
  const IioConverter& converter = inputs[wiring.input];
  const std::optional<double> raw = converter.raw.read();
  if (!raw.has_value()) return lost(converter, errno);
  input = judge(wiring, (*raw + converter.offset) * converter.scale);
  return BusStatus::ok;
}

BusStatus IioBoard::Parts::read_channel(std::size_t channel, Reading& reading) noexcept {
  const ChannelWiring& wiring = settings.wiring[channel];
  reading.sampled_at = monotonic_now();
  JudgedInput displacement;
  if (const BusStatus status = read(wiring.displacement, displacement); status != BusStatus::ok)
    return status;
  reading.displacement_mm = displacement.physical;
  reading.validity = displacement.validity;
  reading.command_readback_kpa = std::numeric_limits<double>::quiet_NaN();
  reading.pressure_kpa = std::numeric_limits<double>::quiet_NaN();
  if (wiring.pressure.has_value()) {
    JudgedInput pressure;
    if (const BusStatus status = read(*wiring.pressure, pressure); status != BusStatus::ok) return status;
    if (pressure.validity == model::Validity::valid) reading.pressure_kpa = pressure.physical;
  }
  reading.temperature_c = std::numeric_limits<double>::quiet_NaN();
  if (wiring.temperature.has_value()) {
    JudgedInput temperature;
    if (const BusStatus status = read(*wiring.temperature, temperature); status != BusStatus::ok)
      return status;
    if (temperature.validity == model::Validity::valid) reading.temperature_c = temperature.physical;
  }
  return BusStatus::ok;
}

IioBoard::IioBoard(const IioSettings& settings) : parts_(std::make_unique<Parts>(settings)) {}

IioBoard::~IioBoard() = default;

std::size_t IioBoard::channels() const noexcept {
  return parts_->settings.wiring.size();
}

BusStatus IioBoard::connect(std::chrono::nanoseconds deadline) noexcept {
  Parts& parts = *parts_;
  parts.open = false;
  const Nanoseconds until = monotonic_now() + deadline.count();
  try {
    parts.attach_all();
  } catch (const std::exception& error) {
    return parts.say(BusStatus::disconnected, "looking for converters", error.what());
  }
  if (!parts.has_output()) return parts.report_missing();
  if (parts.complete() && parts.reads.count() == 0) parts.probe(until);
  parts.open = true;
  return BusStatus::ok;
}

BusStatus IioBoard::exchange(std::span<const double> commands_kpa, std::span<Reading> readings,
                             std::chrono::nanoseconds deadline) noexcept {
  Parts& parts = *parts_;
  const Nanoseconds until = monotonic_now() + deadline.count();
  if (!parts.open) return BusStatus::disconnected;
  if (commands_kpa.size() != channels() || readings.size() != channels() || channels() > most_channels) {
    std::snprintf(parts.detail.data(), parts.detail.size(),
                  "the numbers of commands, readings and channels are not equal");
    return BusStatus::write_refused;
  }
  for (const double command : commands_kpa) {
    if (std::isfinite(command)) continue;
    std::snprintf(parts.detail.data(), parts.detail.size(), "a command that is not a number was not written");
    return BusStatus::write_refused;
  }
  BusStatus written = parts.write_all(commands_kpa);
  if (written == BusStatus::disconnected) return written;
  if (!parts.complete()) return parts.report_missing();
  if (const BusStatus status = parts.beat(); status != BusStatus::ok) return status;
  if (written == BusStatus::ok) written = parts.switch_all_on();
  if (written == BusStatus::disconnected) return written;
  // The new readings are stored here first. If one read fails, the readings of the caller remain unchanged.
  std::array<Reading, most_channels> fresh{};
  for (std::size_t i = 0; i < readings.size(); ++i) {
    fresh[i] = readings[i];
    if (const BusStatus status = parts.read_channel(i, fresh[i]); status != BusStatus::ok) return status;
    ++fresh[i].sequence;
    if (monotonic_now() <= until) continue;
    std::snprintf(parts.detail.data(), parts.detail.size(),
                  "the analog-to-digital conversions took longer than the deadline of the exchange");
    return BusStatus::timed_out;
  }
  if (written != BusStatus::ok) return written;
  std::copy_n(fresh.begin(), readings.size(), readings.begin());
  return BusStatus::ok;
}

const char* IioBoard::detail() const noexcept {
  return parts_->detail.data();
}

bool IioBoard::has_watchdog() const noexcept {
  return parts_->settings.heartbeat.has_value();
}

std::chrono::nanoseconds IioBoard::watchdog_time() const noexcept {
  const auto& heartbeat = parts_->settings.heartbeat;
  return std::chrono::nanoseconds(heartbeat ? nanoseconds(heartbeat->timeout_s) : 0);
}

std::string IioBoard::describe() const {
  std::vector<std::string> devices;
  for (const auto* terminals : {&parts_->written, &parts_->settings.inputs}) {
    for (const IioTerminal& terminal : *terminals) {
      if (std::find(devices.begin(), devices.end(), terminal.device) == devices.end()) {
        devices.push_back(terminal.device);
      }
    }
  }
  std::string text = "industrial I/O:";
  for (const std::string& device : devices) text += " " + device;
  return text;
}

Board::Budget IioBoard::budget() const {
  const Parts& parts = *parts_;
  std::size_t reads = 0;
  for (const ChannelWiring& channel : parts.settings.wiring)
    reads += 1U + (channel.pressure.has_value() ? 1U : 0U) + (channel.temperature.has_value() ? 1U : 0U);
  const std::size_t writes = parts.settings.wiring.size() + (parts.settings.heartbeat ? 1U : 0U);
  // The duration of a write is not measured, because a measurement would change an output. Instead, a write
  // is assumed to take as long as a read.
  const double each_s = parts.reads.median_s();
  Budget cost;
  cost.exchange_s = static_cast<double>(reads + writes) * each_s;
  cost.explanation =
      "industrial I/O, " + std::to_string(writes) + " writes and " + std::to_string(reads) + " conversions" +
      (parts.reads.count() == 0
           ? std::string(", not measured because the board has not been connected yet")
           : " of " + milliseconds(each_s) + " (median of " + std::to_string(parts.reads.count()) +
                 " conversions when connecting, slowest " + milliseconds(parts.reads.slowest_s()) + ")");
  return sum_of({&cost, 1});
}

}  // namespace softgrip::drivers
