#include "tools/commissioning/motion_session.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/statistics.h"
#include "control/elements/fault.h"
#include "control/elements/limits.h"
#include "daemon/loop/bus.h"
#include "daemon/recording/csv_row.h"
#include "rig/rig_file.h"
#include "tools/commissioning/motion_safety.h"

namespace softgrip::tools {
namespace {

using FailureKind = MotionFailure::Kind;

/// Time after the ramp within which the board must confirm the rest pressures [s].
constexpr double confirmation_s = 1;
/// Time for which a measured pressure may be outside its limits, for example while it overshoots [s].
constexpr double overshoot_s = 0.1;
constexpr std::uint64_t least_cycles = 3;

/// Computes the running mean and standard deviation (Welford, Technometrics 4, 1962).
class Gathering {
 public:
  void add(double value) {
    moments_.add(value);
    sample_.lowest = moments_.count == 1 ? value : std::min(sample_.lowest, value);
    sample_.highest = moments_.count == 1 ? value : std::max(sample_.highest, value);
  }
  void miss(model::Validity why) {
    ++sample_.invalid;
    sample_.why = why;
  }
  [[nodiscard]] Sample result() const {
    Sample sample = sample_;
    sample.count = moments_.count;
    sample.mean = moments_.mean;
    sample.deviation = moments_.deviation();
    return sample;
  }

 private:
  Sample sample_;
  Moments moments_;
};

struct ChannelGathering {
  Gathering displacement;
  Gathering pressure;
  Gathering readback;

  void take(const model::Reading& reading) {
    if (reading.validity == model::Validity::valid) {
      displacement.add(reading.displacement_mm);
    } else {
      displacement.miss(reading.validity);
    }
    if (std::isfinite(reading.pressure_kpa)) pressure.add(reading.pressure_kpa);
    if (std::isfinite(reading.command_readback_kpa)) readback.add(reading.command_readback_kpa);
  }
};

Nanoseconds period_of(const rig::RigFile& rig, const drivers::Board& board) {
  return std::max(nanoseconds(1 / rig.settings.rate_hz), nanoseconds(board.budget().exchange_s));
}

/// Returns `reconnect` with a constant pause between connection attempts, because a growing pause is too long
/// for a person who waits for the result.
rig::ReconnectSettings steady(rig::ReconnectSettings reconnect) {
  reconnect.longest_pause = reconnect.first_pause;
  return reconnect;
}

}  // namespace

struct MotionSession::Line {
  Line(const rig::RigFile& rig, drivers::Board& board, const Clock& clock)
      : reconnect(steady(rig.reconnect)),
        bus(board, rig.settings, rig.loop, reconnect, clock, shared, statistics) {}

  rig::ReconnectSettings reconnect;
  daemon::SharedState shared{1, 1};
  daemon::BusStatistics statistics;
  daemon::BusEvent failed;  ///< the latest failure that the bus has reported
  daemon::Bus bus;

  [[nodiscard]] const daemon::BusReport& report() const noexcept { return shared.bus.value(); }
  void take_events() noexcept {
    for (daemon::BusEvent event; shared.bus_events.pop(event);) {
      const bool again = event.kind == daemon::BusEvent::Kind::not_connected;
      if (again || event.kind == daemon::BusEvent::Kind::failed) failed = event;
    }
  }
};

MotionSession::MotionSession(const rig::RigFile& rig, drivers::Board& board, const Clock& clock,
                             StopRequest stop, drivers::GpioLines* lines)
    : rig_(rig),
      board_(board),
      clock_(clock),
      stop_(std::move(stop)),
      lines_(lines),
      line_(std::make_unique<Line>(rig, board, clock)),
      schedule_(clock.now(), period_of(rig, board)),
      readings_(board.channels()),
      pressure_cycles_(board.channels()) {
  for (const control::ChannelSettings& channel : rig.settings.channels) {
    rest_.push_back(control::resting_kpa(channel.limits));
  }
  commands_ = targets_ = rest_;
}

MotionSession::~MotionSession() {
  if (moved_) leave();
}

const daemon::Histogram& MotionSession::exchange_times() const noexcept {
  return line_->statistics.exchange;
}

MotionSession::Expected<void> MotionSession::connect() {
  const bool open = line_->bus.open();
  line_->take_events();
  schedule_ = PeriodicSchedule(clock_.now(), schedule_.period());
  if (open) return {};
  return tl::unexpected(
      MotionFailure{FailureKind::bus, board_.describe() + ": " + complaint(), line_->failed.status});
}

/// Passes the commands to the bus, as the control loop does, and runs one cycle of the bus at the next
/// scheduled time.
void MotionSession::exchange(bool may_rise, bool last) noexcept {
  clock_.sleep_until(schedule_.due());
  daemon::Commands& commands = line_->shared.commands.write_slot();
  commands = {};
  commands.at = clock_.now();
  std::copy(commands_.begin(), commands_.end(), commands.command_kpa.begin());
  std::copy(rest_.begin(), rest_.end(), commands.safe_kpa.begin());
  commands.may_rise = may_rise;
  commands.inhibit = line_->report().health.inhibit;
  commands.last = last;
  line_->shared.commands.publish();
  line_->bus.step(schedule_.due());
  take_report(schedule_.advance(clock_.now()));
}

/// Evaluates the report of the bus about one exchange. If the exchange takes so long that cycles are missed,
/// the missed cycles count as cycles without data, as in daemon/loop/loop.cpp.
void MotionSession::take_report(std::uint64_t skipped_cycles) noexcept {
  line_->shared.bus.fetch();
  line_->take_events();
  const daemon::BusReport& report = line_->report();
  silent_cycles_ = report.health.consecutive_failures == 0 ? 0 : silent_cycles_ + 1 + skipped_cycles;
  if (silent_cycles_ == 0) last_good_ = clock_.now();
  std::copy_n(report.readings.begin(), readings_.size(), readings_.begin());
  for (std::size_t i = 0; i < commands_.size(); ++i) {
    commands_[i] = control::no_further(rest_[i], commands_[i], report.outputs_kpa[i]);
  }
}

/// Returns the text of the latest failure. For a gap in communication, the bus provides the text. For any
/// other failure, the board provides it.
std::string MotionSession::complaint() const {
  const bool gap = line_->failed.status == drivers::BusStatus::watchdog_tripped;
  const std::string text = gap ? line_->failed.detail.data() : board_.detail();
  return text.empty() ? std::string(drivers::name_of(line_->failed.status)) : text;
}

std::optional<MotionFailure> MotionSession::bus_failure() const {
  const control::FaultCode fault = line_->report().health.fault;
  if (fault == control::FaultCode::board_watchdog_tripped) {
    return MotionFailure{FailureKind::bus,
                         complaint() + ". The board has vented the fingers, so the motion has ended",
                         drivers::BusStatus::watchdog_tripped};
  }
  const bool down = silent_cycles_ >= rig_.settings.faults.bus_down_cycles;
  if (!down && !control::inhibits(fault)) return std::nullopt;
  return MotionFailure{FailureKind::bus, complaint(), line_->failed.status};
}

tl::unexpected<MotionFailure> MotionSession::end(MotionFailure failure) {
  ended_ = std::move(failure);
  if (ended_->kind == FailureKind::emergency_stop) static_cast<void>(set_enable(false));
  return tl::unexpected(*ended_);
}

/// Returns a failure if the emergency stop of the rig is pressed or cannot be read. A single reading is
/// sufficient, because a motion by hand can be repeated.
std::optional<MotionFailure> MotionSession::emergency_stop() const {
  const auto role = drivers::GpioRole::emergency_stop;
  if (!rig_.gpio || !rig_.gpio->has(role)) return std::nullopt;
  const std::optional<bool> pressed = lines_ == nullptr ? std::nullopt : lines_->read(role);
  if (pressed && !*pressed) return std::nullopt;
  return MotionFailure{
      FailureKind::emergency_stop,
      pressed ? "the emergency stop is pressed, or its wire is broken" : "the emergency stop cannot be read"};
}

/// Switches the enable output. Returns false if the output cannot be switched. If the rig has no enable
/// output, returns true.
bool MotionSession::set_enable(bool on) noexcept {
  const auto role = drivers::GpioRole::enable;
  if (!rig_.gpio || !rig_.gpio->has(role)) return true;
  return lines_ != nullptr && lines_->write(role, on);
}

MotionSession::Expected<void> MotionSession::step(bool may_rise, const Watch& watch) {
  if (ended_) return tl::unexpected(*ended_);
  if (stop_()) return end({FailureKind::stopped, "stopped by the user"});
  if (moved_) {
    if (auto failure = emergency_stop()) return end(std::move(*failure));
  }
  exchange(may_rise, false);
  if (auto failure = bus_failure()) return end(std::move(*failure));
  if (silent_cycles_ > 0) return {};
  blind_cycles_ = seen() ? 0 : blind_cycles_ + 1;
  if (blind_cycles_ == 0) may_rise_ = true;
  if (blind_cycles_ >= rig_.settings.faults.invalid_reading_cycles) return end(blind());
  if (watch) watch(commands_, readings_);
  // A finger that creeps can leave its limits at a constant pressure.
  if (moved_) {
    if (auto failure = beyond()) return end(std::move(*failure));
    if (auto failure = overpressure()) return end(std::move(*failure));
  }
  return {};
}

void MotionSession::require(Sight sight) {
  required_ = sight;
  blind_cycles_ = 0;
  may_rise_ = false;
}

bool MotionSession::seen() const {
  if (!required_) return true;
  const model::Reading& reading = readings_[required_->channel];
  const bool displacement = !required_->displacement || reading.validity == model::Validity::valid;
  const bool pressure = !required_->pressure || std::isfinite(reading.pressure_kpa);
  return displacement && pressure;
}

MotionFailure MotionSession::blind() const {
  const model::Validity validity = readings_[required_->channel].validity;
  const bool of_displacement = required_->displacement && validity != model::Validity::valid;
  return {FailureKind::blind,
          fmt::format("the {} of `{}`: {} consecutive readings are not valid{}. Fingers are moved only with "
                      "valid readings: check the cable of the sensor{}",
                      of_displacement ? "displacement sensor" : "pressure monitor",
                      rig_.settings.channels[required_->channel].name, blind_cycles_,
                      of_displacement ? fmt::format(" ({})", daemon::name_of(validity)) : "",
                      of_displacement ? ", its supply and its target" : " and its supply")};
}

MotionSession::Expected<std::vector<ChannelSample>> MotionSession::sample(double duration_s,
                                                                          const Watch& watch) {
  std::vector<ChannelGathering> gathering(commands_.size());
  const Nanoseconds end = clock_.now() + nanoseconds(duration_s);
  while (clock_.now() < end) {
    const auto done =
        step(false, [&](const std::vector<double>& commands, const std::vector<model::Reading>& readings) {
          for (std::size_t i = 0; i < gathering.size(); ++i) gathering[i].take(readings[i]);
          if (watch) watch(commands, readings);
        });
    if (!done) return tl::unexpected(done.error());
  }
  std::vector<ChannelSample> samples;
  samples.reserve(gathering.size());
  for (const ChannelGathering& channel : gathering) {
    samples.push_back({channel.displacement.result(), channel.pressure.result(), channel.readback.result()});
  }
  return samples;
}

void MotionSession::follow_targets(double speed_kpa_per_s, double elapsed_s) noexcept {
  for (std::size_t i = 0; i < commands_.size(); ++i) {
    const double furthest = speed_kpa_per_s * elapsed_s;
    const double wanted = std::clamp(targets_[i], commands_[i] - furthest, commands_[i] + furthest);
    commands_[i] =
        control::limit(rig_.settings.channels[i].limits, wanted, commands_[i], elapsed_s).command_kpa;
  }
}

std::optional<MotionFailure> MotionSession::beyond() const {
  for (std::size_t i = 0; i < readings_.size(); ++i) {
    const control::ChannelSettings& channel = rig_.settings.channels[i];
    const bool seen = channel.displacement_used && readings_[i].validity == model::Validity::valid;
    if (!seen || !control::displacement_beyond(channel.limits, readings_[i].displacement_mm)) continue;
    return MotionFailure{FailureKind::beyond,
                         "the finger `" + channel.name + "` left its displacement limits"};
  }
  return std::nullopt;
}

/// Returns a failure if a measured pressure has been outside the pressure limits of its channel for several
/// cycles. The valve or the pressure monitor may be the cause.
std::optional<MotionFailure> MotionSession::overpressure() {
  const std::uint64_t cycles =
      std::max(least_cycles, static_cast<std::uint64_t>(overshoot_s / seconds(schedule_.period())));
  for (std::size_t i = 0; i < readings_.size(); ++i) {
    const double pressure_kpa = readings_[i].pressure_kpa;
    pressure_cycles_[i] = pressure_beyond(rig_, i, pressure_kpa) ? pressure_cycles_[i] + 1 : 0;
    if (pressure_cycles_[i] < cycles) continue;
    return MotionFailure{
        FailureKind::pressure,
        fmt::format("the pressure monitor of `{}` shows {}. Either the points of the valve or the points of "
                    "the pressure monitor in the rig file are wrong: compare both with a manometer at a low "
                    "pressure",
                    rig_.settings.channels[i].name, beyond_text(rig_, i, pressure_kpa))};
  }
  return std::nullopt;
}

MotionSession::Expected<void> MotionSession::ramp(std::size_t channel, double to_kpa, double speed_kpa_per_s,
                                                  const Watch& watch) {
  if (ended_) return tl::unexpected(*ended_);
  if (auto failure = emergency_stop()) return end(std::move(*failure));
  const control::LimitSettings& limits = rig_.settings.channels[channel].limits;
  targets_[channel] = control::in_range(limits, to_kpa);
  while (!may_rise_) {
    if (auto done = step(false, watch); !done) return done;
  }
  moved_ = true;
  if (!set_enable(true)) return end({FailureKind::emergency_stop, "the enable output cannot be switched on"});
  while (commands_[channel] != targets_[channel] || silent_cycles_ > 0) {
    // If the last write was not confirmed, the same commands are written once more. New commands could cause
    // a jump of the pressure after a reconnection.
    if (silent_cycles_ == 0) follow_targets(speed_kpa_per_s, seconds(schedule_.period()));
    if (auto done = step(true, watch); !done) return done;
  }
  return {};
}

MotionSession::Expected<void> MotionSession::wait(const std::function<bool()>& done) {
  while (!done()) {
    if (auto stepped = step(false, {}); !stepped) return stepped;
  }
  return {};
}

bool MotionSession::leave(const Warn& silent) noexcept {
  if (!ended_) ended_ = MotionFailure{FailureKind::stopped, "the motion has ended"};
  const bool confirmed = rest(silent);
  static_cast<void>(set_enable(false));
  moved_ = false;
  return confirmed;
}

/// Ramps all channels to their rest pressures. The ramp to rest continues even if the board does not respond.
/// A board that reconnects during or after the ramp then receives the rest pressures. An attempt to connect
/// may take much longer than a cycle, so the ramp then follows the time instead of the number of cycles.
bool MotionSession::rest(const Warn& silent) noexcept {
  targets_ = rest_;
  double fastest = 0;
  double ramp_s = 0;
  for (std::size_t i = 0; i < rest_.size(); ++i) {
    const control::LimitSettings& limits = rig_.settings.channels[i].limits;
    const double slew = commands_[i] > rest_[i] ? limits.slew_down_kpa_per_s : limits.slew_up_kpa_per_s;
    ramp_s = std::max(ramp_s, std::abs(commands_[i] - rest_[i]) / slew);
    fastest = std::max({fastest, limits.slew_down_kpa_per_s, limits.slew_up_kpa_per_s});
  }
  const Nanoseconds watchdog = board_.watchdog_time().count();
  Nanoseconds stepped = clock_.now();
  const Nanoseconds ramp_end = stepped + nanoseconds(ramp_s);
  Nanoseconds give_up = 0;
  bool told = !silent;
  while (!line_->shared.safe_state_confirmed.load(std::memory_order_relaxed)) {
    const Nanoseconds now = clock_.now();
    const bool vented = watchdog > 0 && now - last_good_ >= watchdog;
    const bool pressed = emergency_stop().has_value();
    if (pressed) static_cast<void>(set_enable(false));
    if (pressed || vented) commands_ = rest_;
    const Nanoseconds elapsed = silent_cycles_ > 0 ? now - stepped : 0;
    follow_targets(fastest, seconds(std::max(elapsed, schedule_.period())));
    stepped = now;
    const bool rested = commands_ == targets_;
    const Nanoseconds rested_at = silent_cycles_ > 0 ? std::min(now, ramp_end) : now;
    if (rested && give_up == 0) give_up = rested_at + nanoseconds(confirmation_s);
    if (give_up != 0 && now > give_up) return false;
    if (const bool down = silent_cycles_ >= rig_.settings.faults.bus_down_cycles; down && !told) {
      told = true;
      silent(complaint());
    }
    exchange(false, rested);
  }
  return true;
}

}  // namespace softgrip::tools
