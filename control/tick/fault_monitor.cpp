#include "control/tick/fault_monitor.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace softgrip::control {

namespace {

FaultCode code_of(model::Validity validity) noexcept {
  switch (validity) {
    case model::Validity::valid:
      return FaultCode::none;
    case model::Validity::none_yet:
    case model::Validity::stale:
      return FaultCode::reading_stale;
    case model::Validity::out_of_range:
      return FaultCode::reading_out_of_range;
    case model::Validity::sensor_error:
      return FaultCode::sensor_error;
    case model::Validity::jumped:
      return FaultCode::reading_jumped;
    case model::Validity::frozen:
      return FaultCode::reading_frozen;
  }
  return FaultCode::sensor_error;
}

/// Returns true if the board itself reports the fault. Such a fault latches at once, without a number of
/// cycles for which it must last.
bool said_by_board(FaultCode code) noexcept {
  return inhibits(code) && code != FaultCode::cycles_lost;
}

/// Returns the number of commands with which a measured value is compared: all commands within the delay,
/// plus one command before the delay and one command after it.
std::size_t window_of(double delay_s, double rate_hz) {
  return static_cast<std::size_t>(std::ceil(delay_s * rate_hz)) + 2;
}

/// Number of pressure windows for which a finger may deflate after the daemon or the bus has started.
constexpr std::size_t grace_windows = 4;

}  // namespace

FaultMonitor::FaultMonitor(const RigSettings& settings)
    : settings_(settings.faults),
      readback_window_(window_of(settings.faults.readback_delay_s, settings.rate_hz)),
      pressure_window_(window_of(settings.faults.pressure_delay_s, settings.rate_hz)),
      channels_(settings.channels.size()) {
  const std::size_t ring =
      settings.faults.pressure_cycles > 0 ? std::max(readback_window_, pressure_window_) : readback_window_;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    displacement_used_.push_back(settings.channels[i].displacement_used);
    pressure_measured_.push_back(settings.channels[i].pressure_measured);
    channels_[i].sent_kpa.assign(ring, resting_kpa(settings.channels[i].limits));
  }
}

Fault FaultMonitor::observe(const TickInput& input, std::span<const ChannelOutput> seen,
                            bool starting) noexcept {
  remember(seen);
  cause_ = {};
  Fault first;
  const auto note = [&first](const Fault& fault) {
    if (first.code == FaultCode::none) first = fault;
  };
  if (input.emergency_stop) note_cause({.code = FaultCode::emergency_stop, .channel = whole_rig});
  if (input.inputs_lost) note_cause({.code = FaultCode::inputs_lost, .channel = whole_rig});
  note(cause_);
  note(bus(input.bus, starting));
  for (std::size_t i = 0; i < channels_.size(); ++i) note(channel(i, input, seen[i], starting));
  if (settings_.overrun_cycles > 0 && input.overrun_cycles >= settings_.overrun_cycles) {
    note({.code = FaultCode::cycles_lost,
          .channel = whole_rig,
          .value = static_cast<double>(input.overrun_cycles)});
  }
  return first;
}

Fault FaultMonitor::bus(const BusHealth& bus, bool starting) noexcept {
  const bool good = bus.connected && bus.consecutive_failures == 0 && bus.fault == FaultCode::none;
  bus_cycles_ = good ? 0 : bus_cycles_ + 1;
  if (good) return {};
  const FaultCode code = bus.fault == FaultCode::none ? FaultCode::bus_down : bus.fault;
  const Fault fault{.code = code, .channel = whole_rig, .value = static_cast<double>(bus_cycles_)};
  // If the daemon cannot reach the board, the watchdog trip is a consequence of the bus fault. Therefore,
  // only the bus fault is reported.
  const bool unreached = !bus.connected && code == FaultCode::board_watchdog_tripped;
  note_cause({.code = unreached ? FaultCode::bus_down : code, .channel = whole_rig, .value = fault.value});
  if (starting && !said_by_board(bus.fault)) return {};
  return inhibits(code) || bus_cycles_ >= settings_.bus_down_cycles ? fault : Fault{};
}

void FaultMonitor::note_cause(const Fault& fault) noexcept {
  if (cause_.code == FaultCode::none) cause_ = fault;
}

Fault FaultMonitor::channel(std::size_t index, const TickInput& input, const ChannelOutput& seen,
                            bool starting) noexcept {
  Channel& channel = channels_[index];
  const auto number = static_cast<std::uint8_t>(index);
  if (seen.request_invalid) {
    return {.code = FaultCode::not_finite, .channel = number};
  }
  const Fault of_reading = displacement_used_[index] ? reading(channel, number, seen, starting) : Fault{};
  const double readback = input.readings[index].command_readback_kpa;
  const bool readback_off = bus_good() && std::isfinite(readback) &&
                            off(channel, readback, readback_window_, settings_.readback_tolerance_kpa);
  channel.readback_cycles = readback_off ? channel.readback_cycles + 1 : 0;
  const bool unsteady = settings_.unsteady_is_fault && seen.unsteady;
  const double pressure_kpa = input.readings[index].pressure_kpa;
  const bool pressure_off = pressure_due(channel, pressure_kpa, starting);
  if (!pressure_measured_[index] || starting || std::isfinite(pressure_kpa)) {
    channel.pressure_invalid_cycles = 0;
  } else if (bus_good()) {
    ++channel.pressure_invalid_cycles;
  }
  const Fault of_pressure{.code = FaultCode::pressure_not_followed, .channel = number, .value = pressure_kpa};
  const Fault of_pressure_monitor{.code = FaultCode::pressure_invalid,
                                  .channel = number,
                                  .value = static_cast<double>(channel.pressure_invalid_cycles)};
  const Fault of_readback{.code = FaultCode::readback_mismatch, .channel = number, .value = readback};
  const Fault of_jumps{.code = FaultCode::reading_jumped, .channel = number, .value = seen.jump_mm};
  if (channel.invalid_cycles > 0)
    note_cause({.code = code_of(seen.validity), .channel = number, .value = seen.age_s});
  if (channel.beyond_cycles > 0) {
    note_cause(
        {.code = FaultCode::displacement_beyond_limits, .channel = number, .value = seen.displacement_mm});
  }
  if (readback_off) note_cause(of_readback);
  if (channel.pressure_cycles > 0) note_cause(of_pressure);
  if (channel.pressure_invalid_cycles > 0) note_cause(of_pressure_monitor);
  if (unsteady) note_cause(of_jumps);
  if (of_reading.code != FaultCode::none) return of_reading;
  if (unsteady) return of_jumps;
  if (readback_off && channel.readback_cycles >= settings_.readback_cycles) return of_readback;
  if (pressure_off) return of_pressure;
  if (channel.pressure_invalid_cycles >= settings_.invalid_reading_cycles) return of_pressure_monitor;
  if (settings_.model_unfit_is_fault && seen.health_changed && seen.health == HealthState::unfit) {
    return {.code = FaultCode::model_unfit, .channel = number, .value = seen.health_rms_mm};
  }
  return {};
}

Fault FaultMonitor::reading(Channel& channel, std::uint8_t index, const ChannelOutput& seen,
                            bool starting) const noexcept {
  const bool silent = seen.validity == model::Validity::none_yet || seen.validity == model::Validity::stale;
  // While the bus is down, missing readings cause no fault of a channel, because the bus fault already covers
  // them. In the first tick after the bus fault, the reading is still old and counts as invalid.
  const bool invalid = seen.validity != model::Validity::valid && !(silent && (starting || !bus_good()));
  channel.invalid_cycles = invalid ? channel.invalid_cycles + 1 : 0;
  channel.beyond_cycles = seen.displacement_beyond ? channel.beyond_cycles + 1 : 0;
  if (invalid && channel.invalid_cycles >= settings_.invalid_reading_cycles) {
    return {.code = code_of(seen.validity), .channel = index, .value = seen.age_s};
  }
  if (channel.beyond_cycles >= settings_.displacement_cycles) {
    return {.code = FaultCode::displacement_beyond_limits, .channel = index, .value = seen.displacement_mm};
  }
  return {};
}

/// Returns true if the measured pressure has differed from the commands for pressure_cycles cycles. A cycle
/// without an exchange or without a valid pressure does not change the number of cycles. Therefore, an
/// unreliable connection or pressure monitor cannot hide a burst pressure line. A channel without a measured
/// pressure never differs from its commands. For a time after start-up and after a bus fault, the pressure is
/// not checked, because the finger may still have an earlier pressure.
bool FaultMonitor::pressure_due(Channel& channel, double pressure_kpa, bool starting) const noexcept {
  if (settings_.pressure_cycles == 0) return false;
  if (starting || bus_cycles_ >= settings_.bus_down_cycles) {
    channel.pressure_grace = static_cast<std::uint32_t>(grace_windows * pressure_window_);
    channel.pressure_cycles = 0;
    return false;
  }
  if (!bus_good()) return false;
  if (channel.pressure_grace > 0) --channel.pressure_grace;
  if (!std::isfinite(pressure_kpa)) return false;
  const bool wrong = channel.pressure_grace == 0 &&
                     off(channel, pressure_kpa, pressure_window_, settings_.pressure_tolerance_kpa);
  channel.pressure_cycles = wrong ? channel.pressure_cycles + 1 : 0;
  return channel.pressure_cycles >= settings_.pressure_cycles;
}

/// Returns true if a pressure is outside the range from the lowest to the highest command of the window, by
/// more than the tolerance. The newest command is compared first, because the pressure usually equals it.
bool FaultMonitor::off(const Channel& channel, double kpa, std::size_t window,
                       double tolerance_kpa) const noexcept {
  const std::vector<double>& sent = channel.sent_kpa;
  std::size_t at = ring_at_;
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  for (std::size_t i = 0; i < std::min(window, sent.size()); ++i) {
    at = (at == 0 ? sent.size() : at) - 1;
    lowest = std::min(lowest, sent[at]);
    highest = std::max(highest, sent[at]);
    if (kpa >= lowest - tolerance_kpa && kpa <= highest + tolerance_kpa) return false;
  }
  return true;
}

void FaultMonitor::remember(std::span<const ChannelOutput> seen) noexcept {
  for (std::size_t i = 0; i < channels_.size(); ++i) channels_[i].sent_kpa[ring_at_] = seen[i].command_kpa;
  if (!channels_.empty() && ++ring_at_ == channels_.front().sent_kpa.size()) ring_at_ = 0;
}

}  // namespace softgrip::control
