#include "control/tick/rig_conditions.h"

#include <cmath>
#include <limits>
#include <optional>

namespace softgrip::control {

RigConditions::Channel::Channel(const RigSettings& rig, const ChannelSettings& settings)
    // Without displacement feedback, a finger counts as at rest after its command has been constant for
    // rest_time_s.
    : rest(settings.displacement_used ? rig.rest_band_mm : 0, rig.rest_time_s),
      rest_kpa(resting_kpa(settings.limits)),
      longest_age(nanoseconds(settings.plausibility.max_age_s)),
      displacement_used(settings.displacement_used) {}

bool RigConditions::Channel::valid(const ChannelOutput& seen) const noexcept {
  return displacement_used && seen.validity == model::Validity::valid;
}

bool RigConditions::Channel::at_rest(const ChannelOutput& seen) const noexcept {
  return seen.command_kpa == rest_kpa;
}

bool RigConditions::Channel::rests(double time_s, const ChannelOutput& seen) noexcept {
  if (!displacement_used) return rest.observe(time_s, seen.command_kpa);
  return rest.observe(time_s, valid(seen) ? std::optional(seen.displacement_mm) : std::nullopt);
}

RigConditions::RigConditions(const RigSettings& settings)
    : monitor_(settings), rest_timeout_s_(settings.rest_timeout_s), margin_mm_(settings.detection.margin_mm) {
  for (const ChannelSettings& channel : settings.channels) channels_.emplace_back(settings, channel);
}

SupervisorInputs RigConditions::observe(const TickInput& input, double time_s, const Supervisor& supervisor,
                                        const SequencePlayer& player,
                                        std::span<ChannelOutput> seen) noexcept {
  forget_old_readings(input.now, seen);
  SupervisorInputs inputs;
  inputs.fault = monitor_.observe(input, seen, supervisor.state() == State::starting);
  inputs.cause = monitor_.cause();
  inputs.bus_good = monitor_.bus_good();
  inputs.phase = player.phase();
  inputs.answers = player.has_answers();
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    inputs.ready |= channels_[i].valid(seen[i]) || !channels_[i].displacement_used ? channel_bit(i) : 0;
    inputs.at_rest |= channels_[i].at_rest(seen[i]) ? channel_bit(i) : 0;
  }
  if (supervisor.state() == State::resynchronising) {
    look_for_rest(*supervisor.sequence(), time_s, seen, inputs);
  }
  inputs.heard = heard(input);
  return inputs;
}

void RigConditions::seek_rest(double time_s) noexcept {
  seeking_since_s_ = time_s;
  for (Channel& channel : channels_) channel.rest.start();
}

void RigConditions::forget_old_readings(Nanoseconds now, std::span<ChannelOutput> seen) noexcept {
  const Nanoseconds gap = last_now_ == no_tick ? 0 : now - last_now_;
  last_now_ = now;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    unheard_ = unheard_ || gap > channels_[i].longest_age;
    if (gap <= channels_[i].longest_age || seen[i].validity != model::Validity::valid) continue;
    seen[i].validity = model::Validity::stale;
    seen[i].pressure_kpa = std::numeric_limits<double>::quiet_NaN();
  }
}

bool RigConditions::heard(const TickInput& input) noexcept {
  const Nanoseconds age = input.now - input.readings.front().sampled_at;
  const bool silent = input.bus.fault == FaultCode::none && input.bus.consecutive_failures == 0 &&
                      age > channels_.front().longest_age;
  unheard_ = unheard_ && silent;
  return !unheard_;
}

/// Checks if all channels of the sequence are at rest. For each vented channel, the model is then shifted to
/// the reading. If a grip of the channel is verified by detection, the shift must not exceed the margin of
/// grip detection. A larger shift can contain creep, and the decay of this creep would later look like an
/// object.
void RigConditions::look_for_rest(const PreparedSequence& sequence, double time_s,
                                  std::span<const ChannelOutput> seen, SupervisorInputs& inputs) noexcept {
  bool all = true;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    if ((sequence.channels & channel_bit(i)) == 0) continue;
    Channel& channel = channels_[i];
    const bool still = channel.rests(time_s, seen[i]);
    const bool follows = channel.displacement_used && channel.at_rest(seen[i]);
    inputs.shiftable |= still && follows ? channel_bit(i) : 0;
    const bool too_far =
        (sequence.needs_detection & channel_bit(i)) != 0 && std::abs(seen[i].offset_mm) > margin_mm_;
    const bool off_model = follows && (!seen[i].synchronised || too_far);
    inputs.unsettled[i] = !still      ? UnsettledReason::moves
                          : off_model ? UnsettledReason::off_model
                                      : UnsettledReason::none;
    all = all && inputs.unsettled[i] == UnsettledReason::none;
  }
  const bool too_late = time_s - seeking_since_s_ >= rest_timeout_s_;
  inputs.rest = all ? Rest::at_rest : too_late ? Rest::timed_out : Rest::pending;
}

}  // namespace softgrip::control
