#include "control/tick/supervisor.h"

#include <algorithm>

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

void refuse(RefusalCode code, const Request& request, EventList& events) noexcept {
  events.add<Event::Kind::request_refused>({code, FaultCode::none}, request.id);
}
}  // namespace

std::string_view name_of(State state) noexcept {
  return state_names[state];
}
std::string_view name_of(SequenceEnd end) noexcept {
  return end_names[end];
}

Supervisor::Supervisor(const RigSettings& settings)
    : safety_(settings.safety), all_((1U << settings.channels.size()) - 1), rig_(rig_key(settings)) {
  venting_ = all_;
}

void Supervisor::go(State state, std::uint32_t request, EventList& events) noexcept {
  state_ = state;
  events.add<Event::Kind::state_changed>(state, request);
}

SupervisorOutputs Supervisor::tick(const TickInput& input, const SupervisorInputs& inputs,
                                   EventList& events) noexcept {
  SupervisorOutputs outputs;
  if (inputs.fault.code != FaultCode::none) latch(inputs, outputs, events);
  answer(input, inputs, outputs, events);
  if (input.interlock_open && playing() && sequence_->interlock == Interlock::always) {
    stop(inputs, 0, outputs, events);
  }
  move_on(inputs, outputs, events);
  outputs.state = state_;
  outputs.venting = venting_;
  outputs.release = outputs.release && state_ == State::running;
  outputs.play = inputs.heard && state_ == State::running;
  return outputs;
}

/// Latches the first fault. Each later fault is reported once, and it can turn a hold into a vent. A later
/// fault has no other effect.
void Supervisor::latch(const SupervisorInputs& inputs, SupervisorOutputs& outputs,
                       EventList& events) noexcept {
  const Fault& fault = inputs.fault;
  std::uint32_t place = 1;
  for (const FaultInfo& info : all_faults()) {
    if (info.code == fault.code) break;
    place <<= 1U;
  }
  if (state_ == State::faulted && (told_ & place) != 0) return;
  told_ |= place;
  events.add_of_channel<Event::Kind::fault_latched>(fault.channel, fault.code, 0, fault.value);
  // After the first fault, the player is idle. Therefore, the safe action of later faults also depends on the
  // phase in which the first fault occurred.
  const bool first = state_ != State::faulted;
  if (first) fault_phase_ = inputs.phase;
  if (action_for(fault.code, fault_phase_) == SafeAction::vent) venting_ = all_;
  if (!first) return;
  first_fault_ = fault;
  outputs.interrupt = SequenceEnd::faulted;
  end_sequence(SequenceEnd::faulted, events);
  go(State::faulted, 0, events);
}

SafeAction Supervisor::action_for(FaultCode code, Phase phase) const noexcept {
  const auto number = static_cast<unsigned>(code);
  // The board has changed its outputs by itself. A hold would keep a command that no longer corresponds to
  // the outputs.
  if (code == FaultCode::board_watchdog_tripped || code == FaultCode::outputs_overwritten)
    return SafeAction::vent;
  // If the inputs cannot be read, the daemon does not see an emergency stop. Therefore, lost inputs count as
  // an emergency stop.
  if (code == FaultCode::emergency_stop || code == FaultCode::inputs_lost) {
    return safety_.on_emergency_stop;
  }
  if (number / 100 == 1 && safety_.board_vents_when_silent) return SafeAction::vent;
  return safety_.safe_action[static_cast<std::size_t>(phase)];
}

std::uint32_t Supervisor::venting_on_leaving(Phase phase) const noexcept {
  const bool decided = state_ == State::faulted || state_ == State::stopping;
  const bool vents = safety_.safe_action[static_cast<std::size_t>(phase)] == SafeAction::vent;
  return !decided && vents ? all_ : venting_;
}

void Supervisor::answer(const TickInput& input, const SupervisorInputs& inputs, SupervisorOutputs& outputs,
                        EventList& events) noexcept {
  const Request& request = input.request;
  const bool halts = request.kind == Request::Kind::stop || request.kind == Request::Kind::vent;
  if (halts && request.of_start == 0) halted_by_ = std::max(halted_by_, request.id);
  if (!halts) taken_ = std::max(taken_, request.id);
  switch (request.kind) {
    case Request::Kind::none:
      break;
    case Request::Kind::start:
      answer_start(input, inputs, outputs, events);
      break;
    case Request::Kind::check:
      answer_check(input, inputs, events);
      break;
    case Request::Kind::stop:
      answer_stop(inputs, request, outputs, events);
      break;
    case Request::Kind::vent:
      answer_vent(request, outputs, events);
      break;
    case Request::Kind::release:
      answer_release(inputs, request, outputs, events);
      break;
    case Request::Kind::acknowledge:
      answer_acknowledge(inputs, request, outputs, events);
      break;
  }
}

RefusalCode Supervisor::refusal_of_start(const TickInput& input,
                                         const SupervisorInputs& inputs) const noexcept {
  if (input.request.id < halted_by_ || withdrawn(input.request.id)) return RefusalCode::overtaken;
  if (state_ == State::faulted) return RefusalCode::faulted;
  if (input.emergency_stop) return RefusalCode::emergency_stop;
  if (state_ == State::starting) return RefusalCode::no_valid_reading;
  if (state_ != State::idle) return RefusalCode::not_idle;
  if (input.interlock_open) return RefusalCode::interlock_open;
  const PreparedSequence* const sequence = input.request.sequence;
  if (sequence == nullptr || sequence->rig != rig_ || sequence->steps.empty()) {
    return RefusalCode::sequence_unfit;
  }
  if (!inputs.bus_good || (sequence->channels & ~inputs.ready) != 0) {
    return RefusalCode::no_valid_reading;
  }
  return RefusalCode::none;
}

bool Supervisor::refuses_start(const TickInput& input, const SupervisorInputs& inputs,
                               EventList& events) const noexcept {
  const RefusalCode refusal = refusal_of_start(input, inputs);
  if (refusal != RefusalCode::none) refuse(refusal, input.request, events);
  return refusal != RefusalCode::none;
}

void Supervisor::answer_check(const TickInput& input, const SupervisorInputs& inputs,
                              EventList& events) const noexcept {
  if (!refuses_start(input, inputs, events)) events.add<Event::Kind::start_checked>({}, input.request.id);
}

void Supervisor::answer_start(const TickInput& input, const SupervisorInputs& inputs,
                              SupervisorOutputs& outputs, EventList& events) noexcept {
  if (refuses_start(input, inputs, events)) return;
  const Request& request = input.request;
  sequence_ = request.sequence;
  start_request_ = request.id;
  outputs.seek_rest = true;
  events.add<Event::Kind::sequence_started>({}, request.id);
  go(State::resynchronising, request.id, events);
}

void Supervisor::answer_stop(const SupervisorInputs& inputs, const Request& request,
                             SupervisorOutputs& outputs, EventList& events) noexcept {
  if (request.of_start != 0) {
    answer_stop_of(inputs, request, outputs, events);
  } else if (playing()) {
    stop(inputs, request.id, outputs, events);
  } else {
    refuse(state_ == State::faulted ? RefusalCode::faulted : RefusalCode::nothing_to_stop, request, events);
  }
}

/// Stops the rig if the running start is the start that the request names. Only the control loop knows which
/// start runs in this tick. Therefore, the loop decides this, and not the client.
void Supervisor::answer_stop_of(const SupervisorInputs& inputs, const Request& request,
                                SupervisorOutputs& outputs, EventList& events) noexcept {
  if (playing() && start_request_ == request.of_start) {
    stop(inputs, request.id, outputs, events);
    return;
  }
  withdraw(request);
  refuse(RefusalCode::named_start_not_running, request, events);
}

/// Remembers the start that a stop request names, if this start may still be in the queue of the loop. When
/// this start arrives, it is refused, because a stop takes effect before the starts in the queue.
void Supervisor::withdraw(const Request& stop) noexcept {
  const bool may_wait = stop.of_start > taken_ && stop.of_start < stop.id;
  if (!may_wait || withdrawn(stop.of_start)) return;
  withdrawn_[next_withdrawn_] = stop.of_start;
  next_withdrawn_ = (next_withdrawn_ + 1) % most_withdrawn;
}

bool Supervisor::withdrawn(std::uint32_t start) const noexcept {
  return start != 0 && std::find(withdrawn_.begin(), withdrawn_.end(), start) != withdrawn_.end();
}

/// Vents all channels. This request is never refused, because an operator must always be able to end a hold,
/// also after a fault.
void Supervisor::answer_vent(const Request& request, SupervisorOutputs& outputs, EventList& events) noexcept {
  venting_ = all_;
  if (state_ == State::faulted || state_ == State::starting) {
    events.add<Event::Kind::state_changed>(state_, request.id);
    return;
  }
  if (playing()) {
    outputs.interrupt = SequenceEnd::stopped;
    end_sequence(SequenceEnd::stopped, events);
  }
  go(State::stopping, request.id, events);
}

/// Ends a hold without a step of the pressure. A running sequence continues with its release step. If no
/// sequence runs, the pressurised channels go to the rest pressure at the slew limit.
void Supervisor::answer_release(const SupervisorInputs& inputs, const Request& request,
                                SupervisorOutputs& outputs, EventList& events) noexcept {
  if (state_ == State::running) {
    outputs.release = true;
    events.add<Event::Kind::release_asked>({}, request.id);
  } else if (state_ == State::faulted) {
    refuse(RefusalCode::faulted, request, events);
  } else if (state_ == State::starting) {
    refuse(RefusalCode::no_valid_reading, request, events);
  } else if (state_ == State::resynchronising || inputs.at_rest != all_) {
    answer_vent(request, outputs, events);
  } else {
    refuse(RefusalCode::nothing_to_release, request, events);
  }
}

void Supervisor::answer_acknowledge(const SupervisorInputs& inputs, const Request& request,
                                    SupervisorOutputs& outputs, EventList& events) noexcept {
  if (state_ == State::faulted) {
    const Fault& cause = inputs.cause;
    if (cause.code != FaultCode::none) {
      events.add_of_channel<Event::Kind::request_refused>(
          cause.channel, {RefusalCode::cause_persists, cause.code}, request.id);
      return;
    }
    events.add_of_channel<Event::Kind::fault_acknowledged>(first_fault_.channel, first_fault_.code,
                                                           request.id);
    first_fault_ = {};
    told_ = 0;
    outputs.acknowledged_by = request.id;
    go(State::starting, request.id, events);
  } else if (inputs.answers) {
    outputs.acknowledged_by = request.id;
  } else {
    refuse(RefusalCode::nothing_to_acknowledge, request, events);
  }
}

void Supervisor::stop(const SupervisorInputs& inputs, std::uint32_t request, SupervisorOutputs& outputs,
                      EventList& events) noexcept {
  if (safety_.safe_action[static_cast<std::size_t>(inputs.phase)] == SafeAction::vent) {
    venting_ |= sequence_->channels;
  }
  outputs.interrupt = SequenceEnd::stopped;
  end_sequence(SequenceEnd::stopped, events);
  go(State::stopping, request, events);
}

void Supervisor::sequence_ended(SequenceEnd end, OnFail action, Phase phase, EventList& events) noexcept {
  const bool vents =
      action == OnFail::vent ||
      (action == OnFail::abort && safety_.safe_action[static_cast<std::size_t>(phase)] == SafeAction::vent);
  if (vents) venting_ |= sequence_->channels;
  end_sequence(end, events);
  go(vents ? State::stopping : State::idle, 0, events);
}

void Supervisor::end_sequence(SequenceEnd end, EventList& events) noexcept {
  if (playing()) events.add<Event::Kind::sequence_finished>(end, start_request_);
  sequence_ = nullptr;
}

void Supervisor::move_on(const SupervisorInputs& inputs, SupervisorOutputs& outputs,
                         EventList& events) noexcept {
  if (state_ == State::starting && inputs.bus_good && inputs.ready == all_) {
    go(State::idle, 0, events);
  } else if (state_ == State::stopping && (venting_ & ~inputs.at_rest) == 0) {
    outputs.vented = venting_;
    go(State::idle, 0, events);
  } else if (state_ == State::resynchronising && !outputs.seek_rest && inputs.rest == Rest::at_rest) {
    venting_ = 0;
    outputs.begin = sequence_;
    go(State::running, start_request_, events);
  } else if (state_ == State::resynchronising && !outputs.seek_rest && inputs.rest == Rest::timed_out) {
    outputs.no_rest = sequence_->channels;
    outputs.unsettled = inputs.unsettled;
    end_sequence(SequenceEnd::failed, events);
    go(State::idle, 0, events);
  }
}

}  // namespace softgrip::control
