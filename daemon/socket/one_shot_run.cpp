#include "daemon/socket/one_shot_run.h"

#include <utility>

#include "base/periodic_schedule.h"

namespace softgrip::daemon {

namespace {

/// Time for which the run continues after the end of the sequence [ns]. The recording needs a part of this
/// time, because it ends 0.5 s after the last motion.
constexpr Nanoseconds end_delay = ns_per_s;

bool at_rest(control::State state) noexcept {
  return state == control::State::idle || state == control::State::faulted;
}

}  // namespace

OneShotRun::OneShotRun(std::shared_ptr<const LoadedSequence> sequence, Nanoseconds idle_timeout)
    : sequence_(std::move(sequence)), idle_timeout_(idle_timeout) {}

void OneShotRun::step(Service& service, Nanoseconds now) {
  if (began_ < 0) began_ = now;
  const control::State rig = service.snapshot().state;
  switch (state_) {
    case State::waiting:
      if (rig == control::State::idle) {
        const auto request = service.submit(control::Request::Kind::start, sequence_);
        if (request) {
          request_ = *request;
          state_ = State::start_requested;
        }
      } else if (now - began_ > idle_timeout_) {
        state_ = State::not_idle;
      }
      break;
    case State::start_requested: {
      const Service::Reply answer = service.take_reply(request_);
      if (answer.kind == Service::Reply::Kind::accepted) state_ = State::running;
      if (answer.kind == Service::Reply::Kind::refused) {
        refusal_ = answer.refusal;
        state_ = State::refused;
      }
      break;
    }
    case State::running:
      if (service.last_finished().request == request_ && !end_) {
        end_ = service.last_finished().end;
        ended_ = now;
      }
      if (end_ && at_rest(rig) && now - ended_ > end_delay) state_ = State::ended;
      break;
    case State::ended:
    case State::refused:
    case State::not_idle:
      break;
  }
}

}  // namespace softgrip::daemon
