#include "control/tick/rig_controller.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "base/enum_table.h"

namespace softgrip::control {

namespace {
constexpr auto state_names = enum_names<State>({{State::starting, "starting"},
                                                {State::idle, "idle"},
                                                {State::resynchronising, "resynchronising"},
                                                {State::running, "running"},
                                                {State::stopping, "stopping"},
                                                {State::faulted, "faulted"}});
constexpr auto end_names = enum_names<SequenceEnd>({{SequenceEnd::done, "done"},
                                                    {SequenceEnd::failed, "failed"},
                                                    {SequenceEnd::stopped, "stopped"},
                                                    {SequenceEnd::faulted, "faulted"}});
ChannelPlayer player_of(const RigSettings& rig, const ChannelSettings& channel, double preview_s) {
  return ChannelPlayer(
      {rig.detection.margin_mm, resting_kpa(channel.limits), preview_s, channel.displacement_used});
}
}  // namespace

std::string_view name_of(State state) noexcept {
  return state_names[state];
}
std::string_view name_of(SequenceEnd end) noexcept {
  return end_names[end];
}

RigController::Channel::Channel(const RigSettings& rig, const ChannelSettings& settings)
    : controller(settings, 1 / rig.rate_hz),
      // Without displacement feedback, a finger counts as at rest after its command has been constant for
      // rest_time_s.
      rest(settings.displacement_used ? rig.rest_band_mm : 0, rig.rest_time_s),
      longest_age(nanoseconds(settings.plausibility.max_age_s)),
      displacement_used(settings.displacement_used) {}

bool RigController::Channel::valid(const ChannelOutput& seen) const noexcept {
  return displacement_used && seen.validity == model::Validity::valid;
}

bool RigController::Channel::at_rest(const ChannelOutput& seen) const noexcept {
  return seen.command_kpa == rest_kpa();
}

bool RigController::Channel::rests(double time_s, const ChannelOutput& seen) noexcept {
  if (!displacement_used) return rest.observe(time_s, seen.command_kpa);
  return rest.observe(time_s, valid(seen) ? std::optional(seen.displacement_mm) : std::nullopt);
}

RigController::RigController(const RigSettings& settings)
    : tick_s_(1 / settings.rate_hz),
      rest_timeout_s_(settings.rest_timeout_s),
      margin_mm_(settings.detection.margin_mm),
      monitor_(settings),
      supervisor_(settings) {
  std::vector<ChannelPlayer> players;
  for (const ChannelSettings& channel : settings.channels) {
    channels_.emplace_back(settings, channel);
    ChannelController& controller = channels_.back().controller;
    controller.start(resting_kpa(channel.limits), output_.channels[output_.channel_count++]);
    players.push_back(player_of(settings, channel, controller.preview_s()));
  }
  player_ = SequencePlayer(std::move(players));
}

const TickOutput& RigController::tick(const TickInput& input) noexcept {
  if (began_ == no_tick) began_ = input.now;
  const double time_s = static_cast<double>(input.now - began_) * 1e-9;
  output_.events.clear();
  forget_old_readings(input.now);
  carry_out(supervisor_.tick(input, supervisor_inputs(input, time_s), output_.events), time_s);
  play(input, time_s);
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const double last_kpa = output_.channels[i].command_kpa;
    control(i, input, time_s);
    stay_within_outputs(i, last_kpa, input);
  }
  conclude();
  output_.state = supervisor_.state();
  output_.first_fault = supervisor_.first_fault();
  output_.cause = monitor_.cause();
  look_for_pressure();
  return output_;
}

/// Limits the command of a channel to the pressure at the board's output while no sequence runs, because only
/// a sequence may move a pressure away from rest. If the bus no longer applies the commands, the command
/// changes at once. Otherwise, the command changes at the slew limits, because the board may still receive a
/// command that was already sent.
void RigController::stay_within_outputs(std::size_t index, double last_kpa, const TickInput& input) noexcept {
  if (may_rise(supervisor_.state()) || index >= input.outputs_kpa.size()) return;
  const Channel& channel = channels_[index];
  double& command_kpa = output_.channels[index].command_kpa;
  double allowed_kpa = no_further(channel.rest_kpa(), command_kpa, input.outputs_kpa[index]);
  if (!inhibits(input.bus.fault)) {
    allowed_kpa = limit(channel.controller.limits(), allowed_kpa, last_kpa, tick_s_).command_kpa;
  }
  command_kpa = no_further(channel.rest_kpa(), allowed_kpa, command_kpa);
}

/// Invalidates the readings of the last tick after a gap between two ticks. A tick bases its decisions on
/// these readings. After a gap, the readings no longer show if a part is held or if a finger is at rest.
void RigController::forget_old_readings(Nanoseconds now) noexcept {
  const Nanoseconds gap = last_now_ == no_tick ? 0 : now - last_now_;
  last_now_ = now;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    ChannelOutput& seen = output_.channels[i];
    unheard_ = unheard_ || gap > channels_[i].longest_age;
    if (gap <= channels_[i].longest_age || seen.validity != model::Validity::valid) continue;
    seen.validity = model::Validity::stale;
    seen.pressure_kpa = std::numeric_limits<double>::quiet_NaN();
  }
}

SupervisorInputs RigController::supervisor_inputs(const TickInput& input, double time_s) noexcept {
  SupervisorInputs inputs;
  inputs.fault = monitor_.observe(input, output_.channels, supervisor_.state() == State::starting);
  inputs.cause = monitor_.cause();
  inputs.bus_good = monitor_.bus_good();
  inputs.phase = player_.phase();
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const ChannelOutput& seen = output_.channels[i];
    inputs.ready |= channels_[i].valid(seen) || !channels_[i].displacement_used ? channel_bit(i) : 0;
    inputs.at_rest |= channels_[i].at_rest(seen) ? channel_bit(i) : 0;
  }
  inputs.answers = player_.has_answers();
  if (supervisor_.state() == State::resynchronising) {
    inputs.rest = look_for_rest(*supervisor_.sequence(), time_s);
  }
  return inputs;
}

/// Checks if all channels of the sequence are at rest. For each vented channel, the model is then shifted to
/// the reading. The shift must not exceed the margin of grip detection. A larger shift can contain creep, and
/// the decay of this creep would later look like an object.
Rest RigController::look_for_rest(const PreparedSequence& sequence, double time_s) noexcept {
  bool all = true;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    Channel& channel = channels_[i];
    const ChannelOutput& seen = output_.channels[i];
    channel.resynchronise = false;
    if ((sequence.channels & channel_bit(i)) == 0) continue;
    const bool still = channel.rests(time_s, seen);
    const bool follows = channel.displacement_used && channel.at_rest(seen);
    channel.resynchronise = still && follows;
    const bool too_far = (sequence.needs_detection & channel_bit(i)) != 0 &&
                         std::abs(channel.controller.offset_mm()) > margin_mm_;
    const bool off_model = follows && (!seen.synchronised || too_far);
    channel.unsettled = !still      ? UnsettledReason::moves
                        : off_model ? UnsettledReason::off_model
                                    : UnsettledReason::none;
    all = all && channel.unsettled == UnsettledReason::none;
  }
  if (all) return Rest::at_rest;
  return time_s - seeking_since_s_ >= rest_timeout_s_ ? Rest::timed_out : Rest::pending;
}

void RigController::report_unsettled(std::uint32_t channels) noexcept {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const Channel& channel = channels_[i];
    if ((channels & channel_bit(i)) != 0 && channel.unsettled != UnsettledReason::none)
      output_.events.add_of_channel<Event::Kind::not_at_rest>(i, channel.unsettled, 0,
                                                              channel.controller.offset_mm());
  }
}

void RigController::carry_out(const SupervisorOutputs& outputs, double time_s) noexcept {
  EventList& events = output_.events;
  if (outputs.interrupt) player_.interrupt(*outputs.interrupt, supervisor_.venting(), events);
  if (outputs.acknowledged_by) player_.acknowledge(*outputs.acknowledged_by, events);
  if (outputs.vented != 0) player_.vented(outputs.vented, events);
  if (outputs.no_rest != 0) {
    report_unsettled(outputs.no_rest);
    player_.refuse(outputs.no_rest, events);
  }
  if (outputs.seek_rest) {
    seeking_since_s_ = time_s;
    for (Channel& channel : channels_) channel.rest.start();
  }
  if (supervisor_.state() != State::resynchronising) {
    for (Channel& channel : channels_) channel.resynchronise = false;
  }
  if (outputs.begin != nullptr) player_.start(*outputs.begin, time_s, output_.channels, events);
  if (outputs.release && supervisor_.state() == State::running) release(time_s);
}

void RigController::release(double time_s) noexcept {
  const Phase phase = player_.phase();
  conclude_sequence(player_.release(time_s, output_.channels, output_.events), phase);
}

void RigController::conclude_sequence(const SequencePlayer::Outcome& outcome, Phase phase) noexcept {
  if (outcome.finished) supervisor_.sequence_ended(outcome.end, outcome.action, phase, output_.events);
}

/// Executes a tick of the sequence. During a gap between two ticks, the board may have vented the fingers.
/// The bus reports such a vent only with the next exchange. Therefore, no step ends before this exchange.
void RigController::play(const TickInput& input, double time_s) noexcept {
  const Nanoseconds age = input.now - input.readings.front().sampled_at;
  const bool silent = input.bus.fault == FaultCode::none && input.bus.consecutive_failures == 0 &&
                      age > channels_.front().longest_age;
  unheard_ = unheard_ && silent;
  if (supervisor_.state() == State::idle) player_.idle_tick(time_s, output_.channels, output_.events);
  if (supervisor_.state() != State::running || unheard_) return;
  const Phase phase = player_.phase();
  conclude_sequence(player_.tick(time_s, output_.channels, output_.events), phase);
}

void RigController::control(std::size_t index, const TickInput& input, double time_s) noexcept {
  Channel& channel = channels_[index];
  const State state = supervisor_.state();
  const bool free_motion = state != State::faulted && state != State::starting &&
                           player_.free_motion(index, channel.at_rest(output_.channels[index]));
  channel.controller.tick(
      {input.now, input.readings[index], demand(index, time_s), channel.resynchronise, free_motion},
      output_.channels[index]);
  tell_changes(index);
  tell_limits(index, time_s);
}

ChannelDemand RigController::demand(std::size_t index, double time_s) const noexcept {
  if (supervisor_.state() == State::running) return player_.demand(index, time_s);
  ChannelDemand demand;
  demand.time_s = time_s;
  const bool vents = (supervisor_.venting() & channel_bit(index)) != 0;
  demand.mode = vents ? ChannelDemand::Mode::vent : ChannelDemand::Mode::hold;
  return demand;
}

void RigController::tell_limits(std::size_t index, double time_s) noexcept {
  ChannelOutput& seen = output_.channels[index];
  const BindingLimit before = seen.limit;
  const std::optional<BindingLimit> now = channels_[index].limits.observe(time_s, seen.bound_by);
  if (!now) return;
  seen.limit = *now;
  if (*now != BindingLimit::none) {
    output_.events.add_of_channel<Event::Kind::limit_binds>(index, *now, 0, seen.command_kpa);
  } else {
    output_.events.add_of_channel<Event::Kind::limit_free>(index, before, 0, seen.command_kpa);
  }
}

void RigController::tell_changes(std::size_t index) noexcept {
  EventList& events = output_.events;
  const ChannelOutput& seen = output_.channels[index];
  const bool valid = seen.validity == model::Validity::valid;
  // Before the first response of the board, a channel has no reading, so no event about a reading is added.
  if (seen.validity != model::Validity::none_yet && valid != channels_[index].valid_before) {
    if (valid) {
      events.add_of_channel<Event::Kind::reading_valid>(index, seen.validity, 0, seen.age_s);
    } else {
      events.add_of_channel<Event::Kind::reading_invalid>(index, seen.validity, 0, seen.age_s);
    }
    channels_[index].valid_before = valid;
  }
  if (seen.unsteady != channels_[index].unsteady_before) {
    channels_[index].unsteady_before = seen.unsteady;
    if (seen.unsteady) {
      events.add_of_channel<Event::Kind::reading_unsteady>(index, {}, 0, seen.jump_mm);
    } else {
      events.add_of_channel<Event::Kind::reading_steady>(index, {}, 0, seen.jump_mm);
    }
  }
  if (seen.health_changed) {
    events.add_of_channel<Event::Kind::model_health_changed>(index, seen.health, 0, seen.health_rms_mm);
  }
}

void RigController::look_for_pressure() noexcept {
  output_.under_pressure = 0;
  if (moves(output_.state)) return;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const bool on = pressed(channels_[i].controller.limits(), output_.channels[i].command_kpa);
    output_.under_pressure |= on ? channel_bit(i) : 0;
  }
}

/// Updates the results of the sequence in the output. Also updates the safe output of each channel, which is
/// written if the loop stops.
void RigController::conclude() noexcept {
  const std::uint32_t venting = supervisor_.venting_on_leaving(player_.phase());
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const ChannelPlayer& played = player_.channel(i);
    ChannelOutput& channel = output_.channels[i];
    channel.result = played.result();
    channel.evidence = played.evidence();
    channel.step = player_.step();
    channel.safe_kpa = (venting & channel_bit(i)) != 0 ? channels_[i].rest_kpa() : channel.command_kpa;
  }
}

}  // namespace softgrip::control
