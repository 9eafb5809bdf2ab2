#include "tests/world/monitor.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace softgrip::world {
namespace {

using control::State;

/// Tolerance for rounding errors when two pressures are compared [kPa].
constexpr double equal_kpa = 1e-9;
/// Longest permitted time from a vent request of a client until the commands are at rest. The time that the
/// slew limits require is not included.
constexpr Nanoseconds vent_bound = ns_per_s / 10;
/// Longest permitted time from a watchdog trip of the board until the daemon latches the fault.
constexpr Nanoseconds trip_bound = ns_per_s / 2;
/// Longest permitted time from the first write of another client until the daemon latches the fault. The
/// daemon reads the outputs first in only 1 of 8 exchanges, and the other client can write between two writes
/// of the daemon.
constexpr Nanoseconds foreign_bound = ns_per_s / 2;

double rest_of(const control::RigSettings& rig, std::size_t channel) {
  return control::resting_kpa(rig.channels[channel].limits);
}

/// Returns the distance of a pressure from the rest pressure [kPa]. If `side` is 1, pressures below rest give
/// 0; if `side` is -1, pressures above rest give 0.
double away_kpa(double rest_kpa, double kpa, double side) {
  return std::max(0.0, side * (kpa - rest_kpa));
}

bool may_follow(State before, State after) {
  switch (after) {
    case State::starting:
      return before == State::faulted;
    case State::idle:
      return before != State::faulted;
    case State::resynchronising:
      return before == State::idle;
    case State::running:
      return before == State::resynchronising || before == State::idle;
    case State::stopping:
      return before == State::running || before == State::resynchronising || before == State::idle ||
             before == State::stopping;
    case State::faulted:
      return true;
  }
  return false;
}

}  // namespace

Monitor::Monitor(const control::RigSettings& rig, Nanoseconds watchdog, Nanoseconds margin)
    : rig_(rig), watchdog_(watchdog), margin_(margin) {
  boots();
}

void Monitor::violate(Nanoseconds at, const char* invariant, std::string text) {
  if (!violation_) violation_ = {at, invariant, std::move(text)};
}

void Monitor::boots() {
  armed_ = armed_at_entry_ = false;
  last_began_ = last_woke_ = exchange_ = before_ = 0;
  state_ = State::starting;
  safe_kpa_.clear();
  for (std::size_t i = 0; i < rig_.channels.size(); ++i) safe_kpa_.push_back(rest_of(rig_, i));
  last_kpa_ = safe_at_entry_ = safe_kpa_;
  foreign_left_.assign(rig_.channels.size(), false);
  halted_by_ = 0;
  seen_by_ = {};
  results_ = {};
  steps_ = {};
  vent_waits_.reset();
  trip_untold_.reset();
  foreign_unseen_.reset();
  dead_.reset();
}

void Monitor::ticked(Nanoseconds now, const control::TickOutput& output) {
  watch_events(now, output);
  watch_state(now, output);
  watch_grips(now, output);
  for (std::size_t i = 0; i < output.channel_count; ++i) {
    const control::ChannelOutput& channel = output.channels[i];
    safe_kpa_[i] = channel.safe_kpa;
    const control::LimitSettings& limits = rig_.channels[i].limits;
    if (!(channel.command_kpa >= limits.pressure_min_kpa - equal_kpa &&
          channel.command_kpa <= limits.pressure_max_kpa + equal_kpa))
      violate(now, "outputs stay in range", fmt::format("channel {}: {} kPa", i, channel.command_kpa));
  }
}

void Monitor::submitted(control::Request::Kind kind, std::uint32_t id) {
  const bool halts = kind == control::Request::Kind::stop || kind == control::Request::Kind::vent;
  if (halts) halted_by_ = std::max(halted_by_, id);
}

void Monitor::watch_events(Nanoseconds now, const control::TickOutput& output) {
  using Kind = control::Event::Kind;
  for (const control::Event& event : output.events) {
    switch (event.kind) {
      case Kind::sequence_started:
        armed_ = true;
        vent_waits_.reset();
        if (event.request < halted_by_)
          violate(now, "a stop or a vent always ends an earlier start",
                  fmt::format("request {} started, although the later request {} is a stop or a vent",
                              event.request, halted_by_));
        break;
      case Kind::fault_latched:
      case Kind::sequence_finished:
        armed_ = false;
        break;
      case Kind::state_changed:
        if (std::get<State>(event.detail) == State::stopping) armed_ = false;
        break;
      default:
        break;
    }
  }
}

void Monitor::watch_state(Nanoseconds now, const control::TickOutput& output) {
  for (const control::Event& event : output.events) {
    if (event.kind != control::Event::Kind::state_changed) continue;
    const auto state = std::get<State>(event.detail);
    if (state != state_ && !may_follow(state_, state))
      violate(now, "the states change only as in the state diagram",
              fmt::format("{} after {}", control::name_of(state), control::name_of(state_)));
    state_ = state;
  }
  if (output.events.lost() > 0) state_ = output.state;
  if (output.state != state_)
    violate(now, "the states change only as in the state diagram",
            fmt::format("{} without an event after {}", control::name_of(output.state),
                        control::name_of(state_)));
  if (state_ == State::faulted) trip_untold_.reset();
}

void Monitor::watch_grips(Nanoseconds now, const control::TickOutput& output) {
  for (std::size_t i = 0; i < output.channel_count; ++i) {
    const control::ChannelOutput& channel = output.channels[i];
    const bool new_grip = channel.result == control::GripResult::holding && results_[i] != channel.result;
    results_[i] = channel.result;
    // The sequence makes its decisions from the readings of the previous tick.
    const Seen seen = std::exchange(seen_by_[i], {now, now - nanoseconds(channel.age_s), channel.validity});
    const bool old = now - seen.at > nanoseconds(rig_.channels[i].plausibility.max_age_s);
    // A grip result ends the grip step. The reading must therefore be newer than the beginning of this step.
    if (new_grip && channel.evidence == control::GripEvidence::displacement &&
        (seen.validity != model::Validity::valid || old || seen.sampled < step_began_[i]))
      violate(now, "HOLDING is based on new readings",
              fmt::format("channel {}: validity {}, seen {:.4f} s ago, sampled {:.4f} s before the step", i,
                          static_cast<int>(seen.validity), seconds(now - seen.at),
                          seconds(step_began_[i] - seen.sampled)));
    if (channel.step != steps_[i] || state_ != State::running) {
      steps_[i] = channel.step;
      step_began_[i] = now;
    }
  }
}

void Monitor::write(Nanoseconds began, Nanoseconds now, std::span<const double> outputs_kpa,
                    std::span<const double> commands_kpa, bool safe_outputs) {
  const double period_s = 1 / rig_.rate_hz;
  // An exchange may consist of several writes. The elapsed time is measured at the first write.
  if (began != last_began_)
    elapsed_s_ = last_began_ == 0 ? period_s : seconds(began - last_began_) + 2 * period_s;
  if (watch_gap(began, now, commands_kpa)) safe_outputs = true;
  last_began_ = began;
  last_woke_ = woke_;
  for (std::size_t i = 0; i < commands_kpa.size(); ++i) {
    const double rest_kpa = rest_of(rig_, i);
    if (outputs_kpa[i] == last_kpa_[i]) foreign_left_[i] = false;
    const double known = known_kpa(i, outputs_kpa[i]);
    const double allowed_kpa = control::no_further(rest_kpa, commands_kpa[i], known);
    if (std::abs(commands_kpa[i] - allowed_kpa) > equal_kpa && !armed_at_entry_)
      violate(now, "no output moves away from rest without a request",
              fmt::format("channel {}: {:.3f} -> {:.3f} kPa in an exchange that began {:.4f} s ago", i,
                          outputs_kpa[i], commands_kpa[i], seconds(now - began)));
    watch_way(now, i, known, commands_kpa[i], elapsed_s_, safe_outputs);
    last_kpa_[i] = commands_kpa[i];
    const control::LimitSettings& limits = rig_.channels[i].limits;
    if (commands_kpa[i] < limits.pressure_min_kpa - equal_kpa ||
        commands_kpa[i] > limits.pressure_max_kpa + equal_kpa)
      violate(now, "outputs stay in range", fmt::format("channel {}: {} kPa is written", i, commands_kpa[i]));
  }
  foreign_ = false;
}

/// Returns the output that the daemon must assume for its next write. This is normally the actual output. If
/// another client has written the output, the function returns the last command in two cases: the daemon has
/// not read the outputs since this write, or the safe action of the daemon is to hold.
double Monitor::known_kpa(std::size_t channel, double output_kpa) const {
  const bool unread = foreign_read_ != foreign_writes_;
  const bool holds = safe_at_entry_[channel] != rest_of(rig_, channel);
  return foreign_left_[channel] && (unread || holds) ? last_kpa_[channel] : output_kpa;
}

/// Checks the first write after a gap in communication. If the gap is so long that the board may have vented,
/// the daemon must write the rest pressures. Returns true if the daemon wrote the rest pressures after such a
/// gap. The daemon reads its clock after it wakes up and before the exchange begins.
bool Monitor::watch_gap(Nanoseconds began, Nanoseconds now, std::span<const double> commands_kpa) {
  if (watchdog_ == 0 || last_began_ == 0 || woke_ == 0) return false;
  bool rested = true;
  for (std::size_t i = 0; i < commands_kpa.size(); ++i)
    rested = rested && std::abs(commands_kpa[i] - rest_of(rig_, i)) <= equal_kpa;
  const Nanoseconds longest = watchdog_ - margin_;
  if (before_ > 0 && woke_ - before_ >= longest && !rested)
    violate(now, "the rest pressure is written if the board may have vented",
            fmt::format("{:.3f} kPa after {:.3f} s", fmt::join(commands_kpa, " "), seconds(woke_ - before_)));
  return rested && began - last_woke_ >= longest;
}

/// Checks the slew limits of a channel in three cases: above the rest pressure, below it, and when the
/// pressure crosses it.
void Monitor::watch_way(Nanoseconds now, std::size_t channel, double output_kpa, double command_kpa,
                        double elapsed_s, bool safe_outputs) {
  const control::LimitSettings& limits = rig_.channels[channel].limits;
  const double rest_kpa = rest_of(rig_, channel);
  // If the board refuses writes, the output does not follow. Therefore compare the command with the last
  // written value.
  const double last_kpa = last_kpa_[channel];
  const double slew = command_kpa > last_kpa ? limits.slew_up_kpa_per_s : limits.slew_down_kpa_per_s;
  const bool crosses = (command_kpa - rest_kpa) * (last_kpa - rest_kpa) < 0;
  if (crosses && std::abs(command_kpa - last_kpa) > slew * elapsed_s + equal_kpa)
    violate(now, "outputs cross the rest pressure within their slew limits",
            fmt::format("channel {}: {:.3f} -> {:.3f} kPa", channel, last_kpa, command_kpa));
  for (const double side : {1.0, -1.0}) {
    const double leaving = side > 0 ? limits.slew_up_kpa_per_s : limits.slew_down_kpa_per_s;
    const double returning = side > 0 ? limits.slew_down_kpa_per_s : limits.slew_up_kpa_per_s;
    const double there_kpa = away_kpa(rest_kpa, command_kpa, side);
    if (there_kpa - away_kpa(rest_kpa, output_kpa, side) > leaving * elapsed_s + equal_kpa)
      violate(now, "outputs change within their slew limits",
              fmt::format("channel {}: {:.3f} -> {:.3f} kPa", channel, output_kpa, command_kpa));
    if (!safe_outputs && away_kpa(rest_kpa, last_kpa, side) - there_kpa > returning * elapsed_s + equal_kpa)
      violate(now,
              "outputs return to rest within their slew limit, except safe outputs without the control loop",
              fmt::format("channel {}: {:.3f} -> {:.3f} kPa", channel, last_kpa, command_kpa));
  }
}

void Monitor::tripped(bool has_spoken) {
  armed_ = armed_at_entry_ = false;
  // After a trip, the outputs are at rest, so the slew limits of the next write start from the rest
  // pressures.
  for (std::size_t i = 0; i < last_kpa_.size(); ++i) last_kpa_[i] = rest_of(rig_, i);
  // If a daemon has had no successful exchange yet, it cannot know of the trip.
  if (!trip_untold_ && has_spoken) trip_untold_ = 0;
}

void Monitor::asked(control::Request::Kind kind) {
  if (kind == control::Request::Kind::vent && !vent_waits_) vent_waits_ = 0;
  if (kind == control::Request::Kind::start) vent_waits_.reset();
}

void Monitor::passed(Nanoseconds now, const Excuse& excuse, std::span<const double> outputs_kpa) {
  const Nanoseconds duration = seen_ == 0 ? 0 : now - seen_;
  seen_ = now;
  bool rested = true;
  double slowest_s = 0;
  for (std::size_t i = 0; i < outputs_kpa.size(); ++i) {
    const double rest_kpa = rest_of(rig_, i);
    rested = rested && std::abs(outputs_kpa[i] - rest_kpa) <= equal_kpa;
    const control::LimitSettings& limits = rig_.channels[i].limits;
    slowest_s = std::max({slowest_s, (limits.pressure_max_kpa - rest_kpa) / limits.slew_down_kpa_per_s,
                          (rest_kpa - limits.pressure_min_kpa) / limits.slew_up_kpa_per_s});
  }
  if (excuse.no_daemon) {
    dead_ = dead_.value_or(0) + duration;
    if (watchdog_ > 0 && *dead_ > watchdog_ + 2 * duration && !rested && !foreign_)
      violate(now, "a board with a watchdog vents after the end of the daemon", "outputs are not at rest");
    return;
  }
  watch_foreign(now, excuse, duration);
  if (excuse.paused || excuse.no_line) return;
  if (vent_waits_) {
    *vent_waits_ += duration;
    if (rested) vent_waits_.reset();
  }
  if (vent_waits_ && *vent_waits_ > vent_bound + nanoseconds(slowest_s))
    violate(now, "a vent is executed within 0.1 s",
            fmt::format("outputs are not at rest {:.3f} s of undisturbed time after the request",
                        seconds(*vent_waits_)));
  if (trip_untold_) *trip_untold_ += duration;
  if (trip_untold_ && *trip_untold_ > trip_bound)
    violate(now, "a tripped watchdog causes a fault", "no fault was latched");
}

void Monitor::foreign_wrote(std::span<const double> outputs_kpa) noexcept {
  foreign_ = true;
  ++foreign_writes_;
  foreign_left_.assign(foreign_left_.size(), true);
  bool differs = false;
  for (std::size_t i = 0; i < outputs_kpa.size(); ++i)
    differs = differs || std::abs(outputs_kpa[i] - last_kpa_[i]) > equal_kpa;
  if (!differs) {
    foreign_unseen_.reset();
  } else if (!foreign_unseen_) {
    foreign_unseen_ = 0;
  }
}

void Monitor::watch_foreign(Nanoseconds now, const Excuse& excuse, Nanoseconds duration) {
  if (!foreign_unseen_ || excuse.paused || excuse.line_but_for_foreign) return;
  // A faulted or starting daemon writes the rest pressures. In these states, the daemon need not report the
  // writes of another client.
  const bool answered = state_ == State::faulted || state_ == State::starting;
  foreign_unseen_ = answered ? 0 : *foreign_unseen_ + duration;
  if (*foreign_unseen_ > foreign_bound)
    violate(now, "writes of another Modbus client are detected",
            fmt::format("another client has written for {:.3f} s, without the time of bus disturbances",
                        seconds(*foreign_unseen_)));
}

void Monitor::left(Nanoseconds now, std::span<const double> outputs_kpa) {
  for (std::size_t i = 0; i < outputs_kpa.size(); ++i) {
    const double allowed_kpa = control::no_further(rest_of(rig_, i), outputs_kpa[i], safe_kpa_[i]);
    if (!foreign_ && std::abs(outputs_kpa[i] - allowed_kpa) > equal_kpa)
      violate(now, "the last outputs are the safe outputs",
              fmt::format("channel {}: the last output is {} kPa, but the safe output is {}", i,
                          outputs_kpa[i], safe_kpa_[i]));
  }
}

void Monitor::answer_is_late(Nanoseconds now, Nanoseconds asked_at) {
  violate(now, "every request receives a reply",
          fmt::format("a request has had no answer for {:.3f} s", seconds(now - asked_at)));
}

}  // namespace softgrip::world
