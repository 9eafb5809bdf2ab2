#include "control/tick/rig_controller.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

namespace softgrip::control {

namespace {
constexpr std::array<std::string_view, 6> state_names{"starting", "idle",     "resynchronising",
                                                      "running",  "stopping", "faulted"};
constexpr std::array<std::string_view, 4> end_names{"done", "failed", "stopped", "faulted"};
constexpr std::uint32_t bit(std::size_t channel) noexcept {
  return 1U << channel;
}

ChannelPlayer player_of(const RigSettings& rig, const ChannelSettings& channel, double preview_s) {
  return ChannelPlayer(
      {rig.detection.margin_mm, channel.limits.pressure_min_kpa, preview_s, channel.displacement_used});
}
}  // namespace

std::string_view name_of(State state) noexcept {
  return state_names[static_cast<std::size_t>(state)];
}
std::string_view name_of(SequenceEnd end) noexcept {
  return end_names[static_cast<std::size_t>(end)];
}

RigController::Channel::Channel(const RigSettings& rig, const ChannelSettings& settings)
    : controller(settings, 1 / rig.rate_hz),
      // Without sight a finger is at rest when its command has not been changed.
      rest(settings.displacement_used ? rig.rest_band_mm : 0, rig.rest_time_s),
      lowest_kpa(settings.limits.pressure_min_kpa),
      sighted(settings.displacement_used) {}

bool RigController::Channel::valid(const ChannelOutput& seen) const noexcept {
  return sighted && seen.validity == model::Validity::valid;
}

bool RigController::Channel::lowest(const ChannelOutput& seen) const noexcept {
  return seen.command_kpa <= lowest_kpa;
}

bool RigController::Channel::rests(double time_s, const ChannelOutput& seen) noexcept {
  if (!sighted) return rest.observe(time_s, seen.command_kpa);
  return rest.observe(time_s, valid(seen) ? std::optional(seen.displacement_mm) : std::nullopt);
}

RigController::RigController(const RigSettings& settings)
    : rest_timeout_s_(settings.rest_timeout_s),
      margin_mm_(settings.detection.margin_mm),
      monitor_(settings),
      supervisor_(settings) {
  std::vector<ChannelPlayer> players;
  for (const ChannelSettings& channel : settings.channels) {
    channels_.emplace_back(settings, channel);
    ChannelController& controller = channels_.back().controller;
    controller.start(channel.limits.pressure_min_kpa, output_.channels[output_.channel_count++]);
    players.push_back(player_of(settings, channel, controller.preview_s()));
  }
  player_ = SequencePlayer(std::move(players));
}

const TickOutput& RigController::tick(const TickInput& input) noexcept {
  if (began_ == no_tick) began_ = input.now;
  const double time_s = static_cast<double>(input.now - began_) * 1e-9;
  output_.events.clear();
  carry_out(supervisor_.tick(input, facts(input, time_s), output_.events), time_s);
  play(time_s);
  stay_below_outputs(input.outputs_kpa);
  for (std::size_t i = 0; i < channels_.size(); ++i) control(i, input, time_s);
  conclude();
  output_.state = supervisor_.state();
  output_.first_fault = supervisor_.first_fault();
  return output_;
}

/// Only a sequence may raise a pressure: a command that never reached the board, or that the board has undone, is
/// forgotten when it ends.
void RigController::stay_below_outputs(std::span<const double> outputs_kpa) noexcept {
  const State state = supervisor_.state();
  if (state == State::running || state == State::resynchronising) return;
  for (std::size_t i = 0; i < std::min(channels_.size(), outputs_kpa.size()); ++i) {
    double& command_kpa = output_.channels[i].command_kpa;
    command_kpa = std::min(command_kpa, outputs_kpa[i]);
  }
}

Facts RigController::facts(const TickInput& input, double time_s) noexcept {
  Facts facts;
  facts.fault = monitor_.observe(input, output_.channels, supervisor_.state() == State::starting);
  facts.cause_present = monitor_.cause_present();
  facts.bus_good = monitor_.bus_good();
  facts.phase = player_.phase();
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const ChannelOutput& seen = output_.channels[i];
    facts.ready |= channels_[i].valid(seen) || !channels_[i].sighted ? bit(i) : 0;
    facts.lowest |= channels_[i].lowest(seen) ? bit(i) : 0;
  }
  facts.answers = player_.has_answers();
  if (supervisor_.state() == State::resynchronising) {
    facts.rest = look_for_rest(*supervisor_.sequence(), time_s);
  }
  return facts;
}

/// All channels of the sequence at rest; those that are vented, and so free, also followed to where they are,
/// by no more than grip detection can stand: what of the offset is creep that is still on its way out would
/// later look like an object.
Rest RigController::look_for_rest(const PreparedSequence& sequence, double time_s) noexcept {
  bool all = true;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    Channel& channel = channels_[i];
    const ChannelOutput& seen = output_.channels[i];
    channel.resynchronise = false;
    if ((sequence.channels & bit(i)) == 0) continue;
    const bool still = channel.rests(time_s, seen);
    const bool follows = channel.sighted && channel.lowest(seen);
    channel.resynchronise = still && follows;
    const bool too_far =
        (sequence.needs_detection & bit(i)) != 0 && std::abs(channel.controller.offset_mm()) > margin_mm_;
    all = all && still && (!follows || (seen.synchronised && !too_far));
  }
  if (all) return Rest::at_rest;
  return time_s - seeking_since_s_ >= rest_timeout_s_ ? Rest::timed_out : Rest::pending;
}

void RigController::carry_out(const Orders& orders, double time_s) noexcept {
  EventList& events = output_.events;
  if (orders.interrupt) player_.interrupt(*orders.interrupt, supervisor_.venting(), events);
  if (orders.acknowledged_by) player_.acknowledge(*orders.acknowledged_by, events);
  if (orders.vented != 0) player_.vented(orders.vented, events);
  if (orders.no_rest != 0) player_.refuse(orders.no_rest, events);
  if (orders.seek_rest) {
    seeking_since_s_ = time_s;
    for (Channel& channel : channels_) channel.rest.start();
  }
  if (supervisor_.state() != State::resynchronising) {
    for (Channel& channel : channels_) channel.resynchronise = false;
  }
  if (orders.begin != nullptr) player_.start(*orders.begin, time_s, output_.channels, events);
}

void RigController::play(double time_s) noexcept {
  if (supervisor_.state() == State::idle) player_.idle_tick(time_s, output_.channels, output_.events);
  if (supervisor_.state() != State::running) return;
  const Phase phase = player_.phase();
  const SequencePlayer::Outcome outcome = player_.tick(time_s, output_.channels, output_.events);
  if (outcome.finished) {
    supervisor_.sequence_ended(outcome.end, outcome.action, phase, output_.events);
  }
}

void RigController::control(std::size_t index, const TickInput& input, double time_s) noexcept {
  Channel& channel = channels_[index];
  const State state = supervisor_.state();
  const bool free_motion = state != State::faulted && state != State::starting && player_.free_motion(index);
  channel.controller.tick(
      {input.now, input.readings[index], demand(index, time_s), channel.resynchronise, free_motion},
      output_.channels[index]);
  tell_changes(index);
}

ChannelDemand RigController::demand(std::size_t index, double time_s) const noexcept {
  if (supervisor_.state() == State::running) return player_.demand(index, time_s);
  ChannelDemand demand;
  demand.time_s = time_s;
  const bool vents = (supervisor_.venting() & bit(index)) != 0;
  demand.mode = vents ? ChannelDemand::Mode::vent : ChannelDemand::Mode::hold;
  return demand;
}

void RigController::tell_changes(std::size_t index) noexcept {
  const ChannelOutput& seen = output_.channels[index];
  const bool valid = seen.validity == model::Validity::valid;
  if (valid != channels_[index].valid_before) {
    output_.events.add_of_channel(index, valid ? Event::Kind::reading_valid : Event::Kind::reading_invalid,
                                  seen.validity, 0, seen.age_s);
    channels_[index].valid_before = valid;
  }
  if (seen.health_changed) {
    output_.events.add_of_channel(index, Event::Kind::model_health_changed, seen.health, 0,
                                  seen.health_rms_mm);
  }
}

/// What the sequence says of the channels, and what each shall do should the loop be left now.
void RigController::conclude() noexcept {
  const std::uint32_t venting = supervisor_.venting_on_leaving(player_.phase());
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const ChannelPlayer& played = player_.channel(i);
    ChannelOutput& channel = output_.channels[i];
    channel.result = played.result();
    channel.evidence = played.evidence();
    channel.step = player_.step();
    channel.safe_kpa = (venting & bit(i)) != 0 ? channels_[i].lowest_kpa : channel.command_kpa;
  }
}

}  // namespace softgrip::control
