#include "control/tick/rig_controller.h"

#include <cstddef>
#include <utility>

namespace softgrip::control {

namespace {
ChannelPlayer player_of(const RigSettings& rig, const ChannelSettings& channel, double preview_s) {
  return ChannelPlayer({.margin_mm = rig.detection.margin_mm,
                        .rest_kpa = resting_kpa(channel.limits),
                        .preview_s = preview_s,
                        .displacement_used = channel.displacement_used});
}
}  // namespace

RigController::RigController(const RigSettings& settings) : conditions_(settings), supervisor_(settings) {
  std::vector<ChannelPlayer> players;
  for (std::size_t i = 0; i < settings.channels.size(); ++i) {
    RigChannel& channel = channels_.emplace_back(settings, i);
    channel.start(output_.channels[output_.channel_count++]);
    players.push_back(player_of(settings, settings.channels[i], channel.preview_s()));
  }
  player_ = SequencePlayer(std::move(players));
}

const TickOutput& RigController::tick(const TickInput& input) noexcept {
  if (began_ == no_tick) began_ = input.now;
  const double time_s = static_cast<double>(input.now - began_) * 1e-9;
  EventList& events = output_.events;
  events.clear();
  const SupervisorInputs conditions =
      conditions_.observe(input, time_s, supervisor_, player_, output_.channels);
  const SupervisorOutputs orders = supervisor_.tick(input, conditions, events);
  if (orders.seek_rest) conditions_.seek_rest(time_s);
  const SequencePlayer::Outcome outcome = player_.tick(orders, time_s, output_.channels, events);
  if (outcome.finished) supervisor_.sequence_ended(outcome.end, outcome.action, outcome.phase, events);
  const State state = supervisor_.state();
  control(input, {.time_s = time_s,
                  .state = state,
                  .venting = supervisor_.venting(),
                  .venting_on_leaving = supervisor_.venting_on_leaving(player_.phase()),
                  .resynchronise = state == State::resynchronising ? conditions.shiftable : 0});
  output_.state = state;
  output_.first_fault = supervisor_.first_fault();
  output_.cause = conditions_.cause();
  return output_;
}

void RigController::control(const TickInput& input, const RigDecision& decision) noexcept {
  output_.under_pressure = 0;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const bool pressed = channels_[i].tick(input, decision, player_, output_.channels[i], output_.events);
    output_.under_pressure |= pressed && !moves(decision.state) ? channel_bit(i) : 0;
  }
}

}  // namespace softgrip::control
