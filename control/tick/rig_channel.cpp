#include "control/tick/rig_channel.h"

#include <optional>

namespace softgrip::control {

RigChannel::RigChannel(const RigSettings& rig, std::size_t index)
    : index_(index),
      tick_s_(1 / rig.rate_hz),
      rest_kpa_(resting_kpa(rig.channels[index].limits)),
      controller_(rig.channels[index], tick_s_) {}

void RigChannel::start(ChannelOutput& channel) noexcept {
  controller_.start(rest_kpa_, channel);
}

bool RigChannel::tick(const TickInput& input, const RigDecision& decision, const SequencePlayer& player,
                      ChannelOutput& channel, EventList& events) noexcept {
  const double last_kpa = channel.command_kpa;
  controller_.tick({.now = input.now,
                    .reading = input.readings[index_],
                    .demand = demand(decision, player),
                    .resynchronise = (decision.resynchronise & channel_bit(index_)) != 0,
                    .free_motion = free_motion(decision, player, channel)},
                   channel);
  tell_changes(channel, events);
  tell_limits(decision.time_s, channel, events);
  if (!may_rise(decision.state)) stay_within_outputs(input, last_kpa, channel);
  const ChannelPlayer& played = player.channel(index_);
  channel.result = played.result();
  channel.evidence = played.evidence();
  channel.step = player.step();
  const bool vents = (decision.venting_on_leaving & channel_bit(index_)) != 0;
  channel.safe_kpa = vents ? rest_kpa_ : channel.command_kpa;
  return pressed(controller_.limits(), channel.command_kpa);
}

ChannelDemand RigChannel::demand(const RigDecision& decision, const SequencePlayer& player) const noexcept {
  if (decision.state == State::running) return player.demand(index_, decision.time_s);
  ChannelDemand demand;
  demand.time_s = decision.time_s;
  const bool vents = (decision.venting & channel_bit(index_)) != 0;
  demand.mode = vents ? ChannelDemand::Mode::vent : ChannelDemand::Mode::hold;
  return demand;
}

bool RigChannel::free_motion(const RigDecision& decision, const SequencePlayer& player,
                             const ChannelOutput& channel) const noexcept {
  return decision.state != State::faulted && decision.state != State::starting &&
         player.free_motion(index_, channel.command_kpa == rest_kpa_);
}

/// Limits the command to the pressure at the board's output while no sequence runs, because only a sequence
/// may move a pressure away from rest. If the bus no longer applies the commands, the command changes at
/// once. Otherwise, the command changes at the slew limits, because the board may still receive a command
/// that was already sent.
void RigChannel::stay_within_outputs(const TickInput& input, double last_kpa,
                                     ChannelOutput& channel) const noexcept {
  if (index_ >= input.outputs_kpa.size()) return;
  double allowed_kpa = no_further(rest_kpa_, channel.command_kpa, input.outputs_kpa[index_]);
  if (!inhibits(input.bus.fault)) {
    allowed_kpa = limit(controller_.limits(), allowed_kpa, last_kpa, tick_s_).command_kpa;
  }
  channel.command_kpa = no_further(rest_kpa_, allowed_kpa, channel.command_kpa);
}

void RigChannel::tell_limits(double time_s, ChannelOutput& channel, EventList& events) noexcept {
  const BindingLimit before = channel.limit;
  const std::optional<BindingLimit> now = limits_.observe(time_s, channel.bound_by);
  if (!now) return;
  channel.limit = *now;
  if (*now != BindingLimit::none) {
    events.add_of_channel<Event::Kind::limit_binds>(index_, *now, 0, channel.command_kpa);
  } else {
    events.add_of_channel<Event::Kind::limit_free>(index_, before, 0, channel.command_kpa);
  }
}

void RigChannel::tell_changes(const ChannelOutput& channel, EventList& events) noexcept {
  const bool valid = channel.validity == model::Validity::valid;
  // Before the first response of the board, a channel has no reading, so no event about a reading is added.
  if (channel.validity != model::Validity::none_yet && valid != valid_before_) {
    if (valid) {
      events.add_of_channel<Event::Kind::reading_valid>(index_, channel.validity, 0, channel.age_s);
    } else {
      events.add_of_channel<Event::Kind::reading_invalid>(index_, channel.validity, 0, channel.age_s);
    }
    valid_before_ = valid;
  }
  if (channel.unsteady != unsteady_before_) {
    unsteady_before_ = channel.unsteady;
    if (channel.unsteady) {
      events.add_of_channel<Event::Kind::reading_unsteady>(index_, {}, 0, channel.jump_mm);
    } else {
      events.add_of_channel<Event::Kind::reading_steady>(index_, {}, 0, channel.jump_mm);
    }
  }
  if (channel.health_changed) {
    events.add_of_channel<Event::Kind::model_health_changed>(index_, channel.health, 0,
                                                             channel.health_rms_mm);
  }
}

}  // namespace softgrip::control
