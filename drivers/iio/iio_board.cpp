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
#include "drivers/iio/iio_device.h"

namespace softgrip::drivers {
namespace {

constexpr int probes = 5;
constexpr const char* stays_off_text =
    "this attribute is still 1 after 0 was written, so the output remains switched off";

/// Returns the name and the bus address of the converter, which must not change while a rig runs. Returns an
/// empty text if the rig file selects the converter by its label or serial number, because these already
/// identify the converter.
std::string identity_behind(const std::string& word, const ComputerDevice& device) {
  const bool says_which = device.has("label", word) || device.has("serial number", word);
  return says_which ? std::string{} : identity_of(device);
}

}  // namespace

struct IioBoard::Parts {
  /// One wired terminal: the attribute that contains its raw number, and the scaling of this number.
  struct Converter {
    std::string name;  // name of the converter in messages
    std::string path;  // path of the attribute that contains the raw number
    std::string identity;
    std::string first_identity;  // identity of the converter in the first session
    IioAttribute raw;
    double scale = 1;   // factor from the raw number to V, mA or kPa
    double offset = 0;  // number that is added to the raw number
    std::string powerdown_path;
    IioAttribute powerdown;
    IioAttribute wake;  // powerdown attribute of the output, open for writing
    bool is_off = false;
    bool stays_off = false;  // true: an earlier attempt to switch on the output had no effect
  };

  explicit Parts(const IioSettings& given)
      : settings(given), written(given.outputs), inputs(given.inputs.size()) {
    if (given.heartbeat) written.push_back(given.heartbeat->terminal);
    outputs.resize(written.size());
  }

  IioSettings settings;
  std::vector<IioTerminal> written;  // terminals that each exchange writes: the outputs, followed by the
                                     // heartbeat
  std::vector<Converter> inputs;
  std::vector<Converter> outputs;  // one converter per terminal of `written`
  bool beats_second = false;
  bool open = false;
  RoundTrip reads;
  std::array<char, 512> detail{};

  BusStatus say(BusStatus status, const std::string& what, const char* why) noexcept {
    std::snprintf(detail.data(), detail.size(), "%s: %s", what.c_str(), why);
    return status;
  }
  /// Ends the session after an error of the converter. The caller has excluded the written number as the
  /// cause of the error.
  BusStatus lost(const Converter& converter, int error) noexcept {
    open = false;
    return say(BusStatus::disconnected, converter.name, error != 0 ? text_of_errno(error) : "no number");
  }

  using Devices = std::vector<ComputerDevice>;
  BusStatus attach(const Devices& there, const IioTerminal& terminal, bool output, Converter& converter);
  BusStatus attach_each(const Devices& there, const std::vector<IioTerminal>& terminals, bool output,
                        std::vector<Converter>& converters);
  BusStatus attach_all();
  BusStatus open_number(const std::filesystem::path& folder, const std::string& channel, bool output,
                        Converter& converter);
  [[nodiscard]] bool uses(std::size_t output) const;
  BusStatus look_at_powerdown(const std::string& channel, Converter& converter);
  BusStatus write_raw(const Converter& converter, long raw) noexcept;
  BusStatus switch_on(Converter& converter) noexcept;
  BusStatus switch_all_on() noexcept;
  BusStatus beat() noexcept;
  BusStatus probe(Nanoseconds deadline) noexcept;
  BusStatus write(std::size_t channel, double command_kpa) noexcept;
  BusStatus read(const InputWiring& wiring, JudgedInput& input) noexcept;
  BusStatus read_channel(std::size_t channel, Reading& reading) noexcept;
};

BusStatus IioBoard::Parts::attach(const Devices& there, const IioTerminal& terminal, bool output,
                                  Converter& converter) {
  converter.name = terminal.device + " " + terminal.channel;
  const auto device = only_device(there, terminal.device, "converter");
  if (!device) {
    return say(BusStatus::disconnected, device.error().message,
               (device.error().hint + ", under " + settings.root).c_str());
  }
  converter.identity = identity_behind(terminal.device, *device);
  if (!converter.first_identity.empty() && converter.identity != converter.first_identity) {
    return say(BusStatus::disconnected, converter.name,
               ("it was " + converter.first_identity + ", but now it is " + converter.identity +
                ": restart softgripd if this change is intended")
                   .c_str());
  }
  const std::filesystem::path folder = std::filesystem::path(settings.root) / device->node;
  return open_number(folder, terminal.channel, output, converter);
}

/// Opens the attribute that contains the raw number of a channel, and reads the scaling of this number.
BusStatus IioBoard::Parts::open_number(const std::filesystem::path& folder, const std::string& channel,
                                       bool output, Converter& converter) {
  const std::string stem = (output ? "out_" : "in_") + channel;
  converter.path = (folder / (stem + "_raw")).string();
  int error = converter.raw.open(converter.path, output);
  // Some drivers have no raw number; their number is already in mV, mA or kPa.
  const bool processed =
      error == ENOENT && !output && converter.raw.open((folder / (stem + "_input")).string(), false) == 0;
  if (error != 0 && !processed) return say(BusStatus::disconnected, converter.path, text_of_errno(error));
  const IioScaling scaling = processed ? scaling_of_processed(channel) : scaling_of(folder, channel, output);
  converter.scale = scaling.scale;
  converter.offset = scaling.offset;
  if (!(std::abs(converter.scale) > 0) || !std::isfinite(converter.scale) ||
      !std::isfinite(converter.offset)) {
    return say(BusStatus::disconnected, converter.name,
               "the converter has no valid attribute `scale`, so its raw values cannot be converted");
  }
  return BusStatus::ok;
}

/// Returns true if a channel is wired to the output. An output without a channel is not changed.
bool IioBoard::Parts::uses(std::size_t output) const {
  return output >= settings.outputs.size() ||
         std::any_of(settings.wiring.begin(), settings.wiring.end(),
                     [&](const ChannelWiring& channel) { return channel.valve.output == output; });
}

BusStatus IioBoard::Parts::look_at_powerdown(const std::string& channel, Converter& converter) {
  const std::filesystem::path folder = std::filesystem::path(converter.path).parent_path();
  converter.is_off = false;
  const std::string name = powerdown_of(folder, channel);
  if (name.empty()) return BusStatus::ok;
  const std::string path = (folder / name).string();
  converter.powerdown_path = path;
  const int error = converter.powerdown.open(path, false);
  const auto state = error == 0 ? converter.powerdown.read() : std::nullopt;
  if (!state) return say(BusStatus::disconnected, path, error != 0 ? text_of_errno(error) : "no number");
  converter.is_off = *state != 0;
  converter.stays_off = converter.stays_off && converter.is_off;
  if (converter.stays_off) return say(BusStatus::disconnected, path, stays_off_text);
  const int denied = converter.is_off ? converter.wake.open(path, true) : 0;
  if (denied == 0) return BusStatus::ok;
  return say(BusStatus::disconnected, path + " is 1 and cannot be cleared", text_of_errno(denied));
}

BusStatus IioBoard::Parts::attach_each(const Devices& there, const std::vector<IioTerminal>& terminals,
                                       bool output, std::vector<Converter>& converters) {
  for (std::size_t i = 0; i < converters.size(); ++i) {
    const BusStatus status = attach(there, terminals[i], output, converters[i]);
    if (status != BusStatus::ok) return status;
    for (std::size_t j = 0; j < i; ++j) {
      if (converters[j].path != converters[i].path) continue;
      return say(BusStatus::disconnected, converters[j].name + " and " + converters[i].name,
                 ("both are " + converters[i].path).c_str());
    }
  }
  return BusStatus::ok;
}

BusStatus IioBoard::Parts::attach_all() {
  const Devices there = converters_in(settings.root);
  BusStatus status = attach_each(there, written, true, outputs);
  for (std::size_t i = 0; status == BusStatus::ok && i < outputs.size(); ++i) {
    if (uses(i)) status = look_at_powerdown(written[i].channel, outputs[i]);
  }
  if (status == BusStatus::ok) status = attach_each(there, settings.inputs, false, inputs);
  if (status != BusStatus::ok) return status;
  for (auto* const converters : {&outputs, &inputs}) {
    for (Converter& converter : *converters) converter.first_identity = converter.identity;
  }
  return status;
}

/// Reads each input several times to measure the duration of a read, which budget() needs.
BusStatus IioBoard::Parts::probe(Nanoseconds deadline) noexcept {
  reads.reset();
  for (int i = 0; i < probes; ++i) {
    for (const Converter& converter : inputs) {
      const Nanoseconds before = monotonic_now();
      if (i > 0 && before > deadline) return BusStatus::ok;
      if (!converter.raw.read().has_value()) return lost(converter, errno);
      reads.add(monotonic_now() - before);
    }
  }
  return BusStatus::ok;
}

BusStatus IioBoard::Parts::switch_on(Converter& converter) noexcept {
  const int error = converter.wake.write(0);
  const std::optional<double> state = converter.powerdown.read();
  converter.is_off = error != 0 || !state || *state != 0;
  converter.stays_off = converter.is_off;
  if (!converter.is_off) return BusStatus::ok;
  open = false;
  return say(BusStatus::disconnected, converter.powerdown_path,
             error != 0 ? text_of_errno(error) : stays_off_text);
}

/// Switches on all outputs that are off. The caller must have written the numbers of all outputs, because
/// several outputs may share one powerdown attribute.
BusStatus IioBoard::Parts::switch_all_on() noexcept {
  for (Converter& converter : outputs) {
    if (!converter.is_off) continue;
    if (const BusStatus status = switch_on(converter); status != BusStatus::ok) return status;
  }
  return BusStatus::ok;
}

BusStatus IioBoard::Parts::write_raw(const Converter& converter, long raw) noexcept {
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
  const Converter& converter = outputs[valve.output];
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

BusStatus IioBoard::Parts::read(const InputWiring& wiring, JudgedInput& input) noexcept {
  const Converter& converter = inputs[wiring.input];
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
    if (const BusStatus status = parts.attach_all(); status != BusStatus::ok) return status;
  } catch (const std::exception& error) {
    return parts.say(BusStatus::disconnected, "looking for converters", error.what());
  }
  const BusStatus status = parts.reads.count() == 0 ? parts.probe(until) : BusStatus::ok;
  parts.open = status == BusStatus::ok;
  return status;
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
  BusStatus written = BusStatus::ok;
  for (std::size_t i = 0; i < commands_kpa.size(); ++i) {
    const BusStatus status = parts.write(i, commands_kpa[i]);
    if (status == BusStatus::disconnected) return status;
    if (status != BusStatus::ok) written = status;
  }
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
