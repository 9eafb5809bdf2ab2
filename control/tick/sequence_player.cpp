#include "control/tick/sequence_player.h"

#include <algorithm>

namespace softgrip::control {

template <class Do>
void SequencePlayer::for_each_of_step(Do&& act) noexcept {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    if ((now().channels & channel_bit(i)) != 0) act(i);
  }
}

SequencePlayer::Outcome SequencePlayer::tick(const SupervisorOutputs& orders, double time_s,
                                             std::span<const ChannelOutput> seen,
                                             EventList& events) noexcept {
  if (orders.interrupt) interrupt(*orders.interrupt, orders.venting, events);
  if (orders.acknowledged_by) acknowledge(*orders.acknowledged_by, events);
  if (orders.vented != 0) vented(orders.vented, events);
  if (orders.no_rest != 0) refuse(orders, seen, events);
  if (orders.begin != nullptr) start(*orders.begin, time_s, seen, events);
  Outcome outcome;
  Phase before = phase();
  if (orders.release) outcome = release(time_s, seen, events);
  if (orders.state == State::idle) idle_tick(time_s, seen, events);
  if (orders.play && !outcome.finished) {
    before = phase();
    outcome = play(time_s, seen, events);
  }
  outcome.phase = before;
  return outcome;
}

void SequencePlayer::start(const PreparedSequence& sequence, double time_s,
                           std::span<const ChannelOutput> seen, EventList& events) noexcept {
  sequence_ = &sequence;
  end_ = SequenceEnd::done;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    if ((sequence.channels & channel_bit(i)) != 0) channels_[i].reset();
  }
  attempts_ = 0;
  begin_step(0, time_s, seen, events);
}

void SequencePlayer::begin_step(std::uint16_t index, double time_s, std::span<const ChannelOutput> seen,
                                EventList& events) noexcept {
  step_ = index;
  play_ = Play::step;
  done_ = 0;
  refused_ = 0;
  for_each_of_step([&](std::size_t i) { channels_[i].begin(now().step, now().plan_of(i), time_s, seen[i]); });
  events.add<Event::Kind::step_started>(index, 0, attempts_);
}

SequencePlayer::Outcome SequencePlayer::play(double time_s, std::span<const ChannelOutput> seen,
                                             EventList& events) noexcept {
  const bool holds = now().step.kind == StepKind::hold;
  bool to_grip = false;
  for_each_of_step([&](std::size_t i) {
    const Progress progress = channels_[i].tick(time_s, seen[i]);
    to_grip |= take_contact(i, seen[i], events);
    if ((refused_ & channel_bit(i)) != 0) return;
    // A channel that passed its step can become pending again while other channels still execute the step.
    if (progress == Progress::pending) done_ &= ~channel_bit(i);
    if (progress == Progress::pending || (done_ & channel_bit(i)) != 0) return;
    done_ |= channel_bit(i);
    if (progress == Progress::failed) {
      refused_ |= channel_bit(i);
      if (holds) lose(i, events);
    }
  });
  if (to_grip) return go_to_step(now().grip_step, time_s, seen, events);
  // If a part is lost during a hold, the sequence reacts at once. In all other cases, the sequence waits
  // until every channel of the step has a result.
  if (done_ != now().channels && !(holds && refused_ != 0)) {
    return {};
  }
  if (play_ == Play::backing_off) {
    begin_step(step_, time_s, seen, events);
    return {};
  }
  if (refused_ != 0) return failed(time_s, seen, events);
  for_each_of_step([&](std::size_t i) { answer_passed(i, time_s, events); });
  return next_step(step_ + std::size_t{1}, time_s, seen, events);
}

SequencePlayer::Outcome SequencePlayer::next_step(std::size_t index, double time_s,
                                                  std::span<const ChannelOutput> seen,
                                                  EventList& events) noexcept {
  if (index < sequence_->steps.size()) {
    attempts_ = 0;
    begin_step(static_cast<std::uint16_t>(index), time_s, seen, events);
    return {};
  }
  return finished(OnFail::hold, events);
}

/// Ends the present step and begins another step. A channel that does not take part in the new step keeps its
/// command.
SequencePlayer::Outcome SequencePlayer::go_to_step(std::size_t index, double time_s,
                                                   std::span<const ChannelOutput> seen,
                                                   EventList& events) noexcept {
  const std::uint32_t going = index < sequence_->steps.size() ? sequence_->steps[index].channels : 0;
  for_each_of_step([&](std::size_t i) {
    if ((going & channel_bit(i)) == 0) channels_[i].freeze();
  });
  return next_step(index, time_s, seen, events);
}

/// Reports a new contact of the channel. Returns true if the sequence must continue with its next grip step.
bool SequencePlayer::take_contact(std::size_t channel, const ChannelOutput& seen,
                                  EventList& events) noexcept {
  const std::optional<OnContact> met = channels_[channel].take_contact();
  if (!met) return false;
  events.add_of_channel<Event::Kind::contact>(channel, *met, 0, seen.displacement_mm);
  return met == OnContact::grip && now().grip_step < sequence_->steps.size();
}

SequencePlayer::Outcome SequencePlayer::release(double time_s, std::span<const ChannelOutput> seen,
                                                EventList& events) noexcept {
  if (plays(StepKind::release)) return {};
  if (!plays(StepKind::hold) && end_ == SequenceEnd::done) end_ = SequenceEnd::stopped;
  const std::size_t to = now().release_step;
  if (to < sequence_->steps.size()) return go_to_step(to, time_s, seen, events);
  return finished(OnFail::vent, events);
}

SequencePlayer::Outcome SequencePlayer::failed(double time_s, std::span<const ChannelOutput> seen,
                                               EventList& events) noexcept {
  const Step& step = now().step;
  if (attempts_ < step.retries) {
    ++attempts_;
    play_ = Play::backing_off;
    done_ = 0;
    refused_ = 0;
    for_each_of_step([&](std::size_t i) { channels_[i].back_off(time_s, seen[i]); });
    return {};
  }
  end_ = SequenceEnd::failed;
  for_each_of_step([&](std::size_t i) {
    if ((refused_ & channel_bit(i)) == 0) {
      answer_passed(i, time_s, events);
    } else if (step.kind != StepKind::hold) {
      answer(i, channels_[i].failure(), channels_[i].evidence_of(step.verify.by), events);
    }
  });
  if (step.on_fail == OnFail::carry_on) {
    return next_step(step_ + std::size_t{1}, time_s, seen, events);
  }
  if (step.on_fail == OnFail::release && now().release_step < sequence_->steps.size()) {
    return next_step(now().release_step, time_s, seen, events);
  }
  return finished(step.on_fail == OnFail::release ? OnFail::vent : step.on_fail, events);
}

/// Sets the grip result of a channel that has passed its step.
void SequencePlayer::answer_passed(std::size_t channel, double time_s, EventList& events) noexcept {
  ChannelPlayer& player = channels_[channel];
  const Step& step = now().step;
  if (step.kind == StepKind::grip) {
    player.answer_holding(time_s);
    tell(channel, events);
  } else if (step.kind == StepKind::release &&
             (player.result() == GripResult::none || player.result() == GripResult::holding)) {
    answer(channel, GripResult::released, player.evidence_of(VerifyBy::detection), events);
  }
}

void SequencePlayer::answer(std::size_t channel, GripResult result, GripEvidence evidence,
                            EventList& events) noexcept {
  channels_[channel].answer(result, evidence);
  tell(channel, events);
}

void SequencePlayer::tell(std::size_t channel, EventList& events) const noexcept {
  const ChannelPlayer& player = channels_[channel];
  events.add_of_channel<Event::Kind::grip_result>(channel, {player.result(), player.evidence()}, 0,
                                                  player.shortfall_mm());
}

void SequencePlayer::lose(std::size_t channel, EventList& events) noexcept {
  answer(channel, GripResult::part_lost, channels_[channel].evidence(), events);
}

SequencePlayer::Outcome SequencePlayer::finished(OnFail action, EventList& events) noexcept {
  if (end_ != SequenceEnd::done) answer_the_rest(events);
  stop_playing();
  return {.finished = true, .end = end_, .action = action};
}

/// Sets the result ERROR for every channel of the sequence that has no grip result.
void SequencePlayer::answer_the_rest(EventList& events) noexcept {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    if ((sequence_->channels & channel_bit(i)) != 0 && channels_[i].result() == GripResult::none) {
      answer(i, GripResult::error, GripEvidence::none, events);
    }
  }
}

void SequencePlayer::stop_playing() noexcept {
  for (std::size_t i = 0; i < channels_.size(); ++i) channels_[i].freeze();
  sequence_ = nullptr;
  play_ = Play::nothing;
}

void SequencePlayer::interrupt(SequenceEnd end, std::uint32_t venting, EventList& events) noexcept {
  const std::uint32_t half_released = plays(StepKind::release) ? now().channels & ~venting : 0;
  if (play_ != Play::nothing) answer_the_rest(events);
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const bool unsure = end == SequenceEnd::faulted || (half_released & channel_bit(i)) != 0;
    if (unsure && channels_[i].result() == GripResult::holding) {
      answer(i, GripResult::error, GripEvidence::none, events);
    }
  }
  stop_playing();
}

void SequencePlayer::idle_tick(double time_s, std::span<const ChannelOutput> seen,
                               EventList& events) noexcept {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    if (channels_[i].idle(time_s, seen[i])) lose(i, events);
  }
}

void SequencePlayer::vented(std::uint32_t channels, EventList& events) noexcept {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    if ((channels & channel_bit(i)) != 0 && channels_[i].result() == GripResult::holding) {
      answer(i, GripResult::released, GripEvidence::none, events);
    }
  }
}

void SequencePlayer::refuse(const SupervisorOutputs& orders, std::span<const ChannelOutput> seen,
                            EventList& events) noexcept {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    if ((orders.no_rest & channel_bit(i)) != 0 && orders.unsettled[i] != UnsettledReason::none)
      events.add_of_channel<Event::Kind::not_at_rest>(i, orders.unsettled[i], 0, seen[i].offset_mm);
  }
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    if ((orders.no_rest & channel_bit(i)) != 0) answer(i, GripResult::error, GripEvidence::none, events);
  }
}

bool SequencePlayer::has_answers() const noexcept {
  return std::any_of(channels_.begin(), channels_.end(), [](const ChannelPlayer& channel) {
    return channel.result() != GripResult::none && channel.result() != GripResult::holding;
  });
}

void SequencePlayer::acknowledge(std::uint32_t request, EventList& events) noexcept {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const GripResult result = channels_[i].result();
    if (result != GripResult::none && result != GripResult::holding) {
      channels_[i].answer(GripResult::none, GripEvidence::none);
      events.add_of_channel<Event::Kind::grip_result>(i, {}, request);
    }
  }
}

ChannelDemand SequencePlayer::demand(std::size_t channel, double time_s) const noexcept {
  return channels_[channel].demand(time_s);
}

Phase SequencePlayer::phase() const noexcept {
  if (plays(StepKind::release)) return Phase::releasing;
  const bool holding = std::any_of(channels_.begin(), channels_.end(), [](const ChannelPlayer& channel) {
    return channel.result() == GripResult::holding;
  });
  if (holding) return Phase::holding;
  return play_ != Play::nothing ? Phase::closing : Phase::idle;
}

bool SequencePlayer::free_motion(std::size_t channel, bool at_rest) const noexcept {
  const ChannelPlayer& player = channels_[channel];
  if (player.result() == GripResult::holding) return false;
  if (player.stopped_by_contact()) return false;
  // Track and pressure steps expect no contact. If the displacement differs from the model, the reason is a
  // blocked line or a changed finger.
  if (plays(StepKind::track) || plays(StepKind::pressure)) return true;
  const bool may_touch = plays(StepKind::grip) || plays(StepKind::hold) || plays(StepKind::release);
  return may_touch ? !player.touching() : at_rest || !player.held_back();
}

}  // namespace softgrip::control
