#include "control/tick/channel_player.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace softgrip::control {

namespace {
/// Duration for which past values of the reference are kept [s]. The feedback compares a reading with the
/// reference at the time of the reading, which is in the past.
constexpr double kept_s = 1;
using Mode = ChannelDemand::Mode;

/// Appends a ramp that ends at `value`, with the speed or the duration of `target`. Returns false if the
/// reference has no space for the ramp.
bool append_ramp(Reference& reference, const Target& target, double value) noexcept {
  if (target.speed > 0) return reference.ramp_to(value, target.speed);
  if (target.duration_s > 0) return reference.ramp_for(value, target.duration_s);
  reference.start(reference.end_s(), value);
  return true;
}

/// Appends a segment with function(reference). If the reference has no space for the segment, past segments
/// are discarded first. Their number grows with many short steps. Returns false if the segment is not
/// permitted.
template <class Function>
bool append(Reference& reference, double time_s, const Function& function) noexcept {
  if (function(reference)) return true;
  reference.forget_before(time_s);
  return function(reference);
}

/// Returns the target with another value. The ramp has the same speed or duration.
Target with_value(Target target, double value) noexcept {
  target.value = value;
  return target;
}

}  // namespace

void ChannelPlayer::reset() noexcept {
  step_ = nullptr;
  stage_ = Stage::done;
  freeze();
  bounds_ = {};
  contact_.reset();
  follow_.reset();
  touching_since_s_.reset();
  stopped_by_contact_ = false;
  answer(GripResult::none, GripEvidence::none);
}

void ChannelPlayer::answer(GripResult result, GripEvidence evidence) noexcept {
  result_ = result;
  evidence_ = evidence;
}

void ChannelPlayer::answer_holding(double time_s) noexcept {
  held_by_ = step_->verify;
  answer(GripResult::holding, evidence_of(held_by_.by));
  watch_from(time_s, held_by_.window_s);
}

GripEvidence ChannelPlayer::evidence_of(VerifyBy by) const noexcept {
  if (by == VerifyBy::pressure) return GripEvidence::pressure;
  return traits_.displacement_used ? GripEvidence::displacement : GripEvidence::none;
}

void ChannelPlayer::begin(const Step& step, const PressurePlan* plan, double time_s,
                          const ChannelOutput& seen) noexcept {
  step_ = &step;
  if (step.kind != StepKind::hold) {
    plan_ = plan;
    plan_origin_s_ = plan != nullptr ? time_s - plan->begin_s : 0;
    bounds_ = {};
  } else if (profile_ || squeezing_) {
    // The profile and the gripping pressure belong to the previous step. The hold keeps their last pressure.
    stay_at(pressure_kpa_, time_s);
  }
  profile_ = squeezing_ = stopped_by_contact_ = false;
  met_ = verified_ = false;
  contact_met_.reset();
  bounds_.pressure_max_kpa = std::min(bounds_.pressure_max_kpa, step.bounds.pressure_max_kpa);
  bounds_.squeeze_max_kpa = std::min(bounds_.squeeze_max_kpa, step.bounds.squeeze_max_kpa);
  failure_ = GripResult::error;
  deadline_s_ = step.timeout_s ? time_s + *step.timeout_s : infinite;
  switch (step.kind) {
    case StepKind::move:
    case StepKind::grip:
      start_ = with_value(step.target, go_to(step.target, step.target.value, time_s, seen));
      closing_ = step.target.value > start_.value;
      stage_ = Stage::ramp;
      break;
    case StepKind::release: {
      // A release step that begins early may start below its target pressure. In this case, the release step
      // must not increase the pressure.
      const double value = step.target.at_rest
                               ? traits_.rest_kpa
                               : no_further(traits_.rest_kpa, step.target.value, seen.command_kpa);
      start_ = with_value(step.target, go_to(step.target, value, time_s, seen));
      closing_ = false;
      stage_ = Stage::ramp;
      break;
    }
    case StepKind::hold:
      watch_from(time_s, step.reverify_every_s);
      stage_end_s_ = time_s + step.hold_s;
      stage_ = Stage::watch;
      break;
    case StepKind::track:
      closing_ = true;
      stage_ = begin_track(step.sine, time_s, seen) ? Stage::profile : Stage::failed;
      break;
    case StepKind::pressure:
      mode_ = Mode::pressure;
      start_ = {Target::Quantity::pressure_kpa, seen.command_kpa};
      profile_ = closing_ = true;
      profile_start_s_ = time_s;
      pressure_kpa_ = value_at(step.profile, 0);
      stage_end_s_ = time_s + duration_s(step.profile);
      stage_ = Stage::profile;
      break;
  }
}

/// Appends the sine of a track step to the reference. Returns false if the finger does not follow the
/// reference, for example because an object stopped it in the previous step. A retry of the step then begins
/// at the present command.
bool ChannelPlayer::begin_track(const Sine& sine, double time_s, const ChannelOutput& seen) noexcept {
  start_ = {Target::Quantity::pressure_kpa, seen.command_kpa};
  if (mode_ != Mode::displacement) return false;
  displacement_.forget_before(time_s - kept_s);
  start_ = {Target::Quantity::displacement_mm, displacement_.value_at(time_s)};
  start_.speed = 2 * std::numbers::pi * sine.frequency_hz * sine.amplitude_mm;
  displacement_.cut(time_s + traits_.preview_s);
  const bool appended = append(displacement_, time_s, [&](Reference& reference) {
    return reference.sine(sine.mean_mm, sine.amplitude_mm, sine.frequency_hz, sine.cycles);
  });
  stage_end_s_ = displacement_.end_s();
  return appended;
}

/// Starts the ramp to a target. A displacement ramp starts at the present reference, or at the displacement
/// of the finger if there is no reference. A pressure ramp starts at the last command. Returns the value at
/// which the ramp starts.
double ChannelPlayer::go_to(const Target& target, double value, double time_s,
                            const ChannelOutput& seen) noexcept {
  double start = 0;
  Reference& reference = target.quantity == Target::Quantity::displacement_mm ? displacement_ : pressure_;
  if (target.quantity == Target::Quantity::pressure_kpa) {
    reference.start(time_s, seen.command_kpa);
    start = seen.command_kpa;
    mode_ = Mode::pressure;
    pressure_kpa_ = seen.command_kpa;
  } else if (mode_ == Mode::displacement) {
    reference.forget_before(time_s - kept_s);
    start = reference.value_at(time_s);
    reference.cut(time_s + traits_.preview_s);
  } else {
    reference.start(time_s, seen.displacement_mm);
    reference.hold_for(traits_.preview_s);
    start = seen.displacement_mm;
    mode_ = Mode::displacement;
  }
  append(reference, time_s, [&](Reference& own) { return append_ramp(own, target, value); });
  ramp_end_s_ = reference.end_s();
  return start;
}

void ChannelPlayer::back_off(double time_s, const ChannelOutput& seen) noexcept {
  plan_ = nullptr;
  verified_ = squeezing_ = stopped_by_contact_ = profile_ = false;
  go_to(start_, start_.value, time_s, seen);
  deadline_s_ = infinite;
  stage_ = Stage::back;
}

bool ChannelPlayer::valid(const ChannelOutput& seen) const noexcept {
  return traits_.displacement_used && seen.validity == model::Validity::valid;
}

void ChannelPlayer::take(const ChannelOutput& seen) noexcept {
  shortfall_mm_ = valid(seen) ? -seen.residual_mm : std::numeric_limits<double>::quiet_NaN();
}

void ChannelPlayer::feel(const ChannelOutput& seen, bool watched) noexcept {
  if (!watched) return;
  contact_.observe(shortfall_mm_);
  follow_.observe(contact_.touching(), seen.displacement_mm, seen.displacement_mm + shortfall_mm_);
}

bool ChannelPlayer::idle(double time_s, const ChannelOutput& seen) noexcept {
  take(seen);
  feel(seen, !seen.stands_still);
  return watch(time_s, seen);
}

Progress ChannelPlayer::tick(double time_s, const ChannelOutput& seen) noexcept {
  take(seen);
  // While the sensor may be frozen, contact is evaluated only in a release step. The reading of a frozen
  // sensor looks like the reading of a finger that an object stops.
  feel(seen, !seen.stands_still || step_->kind == StepKind::release);
  look_for_contact(time_s, seen);
  Progress progress = advance(time_s, seen);
  if (mode_ == Mode::pressure) {
    pressure_kpa_ = squeezing_ ? squeezing_kpa(time_s, seen) : pressure_at(time_s);
  }
  if (progress == Progress::pending && time_s >= deadline_s_) {
    // The result NO PART requires a verification window with usable readings. If readings in the window are
    // unusable, the result is ERROR.
    const bool looked = stage_ == Stage::verify && !window_.blinded(time_s);
    failure_ = looked ? GripResult::no_part : GripResult::error;
    progress = Progress::failed;
  }
  if (progress == Progress::failed) stage_ = Stage::done;
  return progress;
}

double ChannelPlayer::pressure_at(double time_s) const noexcept {
  if (profile_) return value_at(step_->profile, time_s - profile_start_s_);
  return pressure_.value_at(time_s);
}

Progress ChannelPlayer::advance(double time_s, const ChannelOutput& seen) noexcept {
  if (stopped_by_contact_) return stopped(seen);
  if (squeezing_ && !squeezes_on(time_s, seen)) return Progress::pending;
  switch (stage_) {
    case Stage::squeeze:
    case Stage::ramp:
      return time_s >= ramp_end_s_ ? after_ramp(time_s, seen) : Progress::pending;
    case Stage::settle:
      return settle(time_s, seen);
    case Stage::verify:
      return verify(time_s, seen);
    case Stage::watch:
      if (watch(time_s, seen)) return Progress::failed;
      return time_s >= stage_end_s_ ? pass() : Progress::pending;
    case Stage::purge:
    case Stage::free:
      return release(time_s);
    case Stage::profile:
      return time_s >= stage_end_s_ ? pass() : Progress::pending;
    case Stage::back:
      return time_s >= ramp_end_s_ + step_->settle_s ? pass() : Progress::pending;
    case Stage::failed:
      return Progress::failed;
    case Stage::done:
      break;
  }
  // A verified channel that has no usable reading at present stays pending, because it cannot confirm that
  // the finger still holds the part.
  return verified_ && !usable(step_->verify, seen) ? Progress::pending : Progress::passed;
}

Progress ChannelPlayer::pass() noexcept {
  stage_ = Stage::done;
  return Progress::passed;
}

Progress ChannelPlayer::after_ramp(double time_s, const ChannelOutput& seen) noexcept {
  if (step_->kind == StepKind::release) {
    stage_ = Stage::purge;
    mode_ = Mode::vent;
    stage_end_s_ = time_s + step_->purge_s;
    return Progress::pending;
  }
  stage_ = Stage::settle;
  stage_end_s_ = time_s + step_->settle_s;
  within_ = false;
  return settle(time_s, seen);
}

Progress ChannelPlayer::settle(double time_s, const ChannelOutput& seen) noexcept {
  if (step_->tolerance_mm) {
    const double target = step_->target.value;
    const bool within = valid(seen) && std::abs(seen.displacement_mm - target) <= *step_->tolerance_mm;
    if (within && !within_) stage_end_s_ = time_s + step_->settle_s;
    within_ = within;
    if (!within) return Progress::pending;
  }
  if (time_s < stage_end_s_) return Progress::pending;
  if (step_->kind != StepKind::grip) return pass();
  // The pressure at the end of the settling time is kept during verification and hold.
  if (squeezing_) stay_at(pressure_kpa_, time_s);
  stage_ = Stage::verify;
  window_.start(time_s, step_->verify.window_s);
  return verify(time_s, seen);
}

bool ChannelPlayer::usable(const Verify& verify, const ChannelOutput& seen) const noexcept {
  if (verify.by == VerifyBy::pressure) return std::isfinite(seen.pressure_kpa);
  return std::isfinite(shortfall_mm_) && !seen.stands_still;
}

bool ChannelPlayer::evident(const Verify& verify, const ChannelOutput& seen) const noexcept {
  if (verify.by == VerifyBy::pressure) {
    return seen.pressure_kpa >= verify.pressure_min_kpa && seen.pressure_kpa <= verify.pressure_max_kpa;
  }
  const bool inside = seen.displacement_mm >= verify.displacement_min_mm &&
                      seen.displacement_mm <= verify.displacement_max_mm;
  return inside && (verify.by == VerifyBy::position || shortfall_mm_ >= traits_.margin_mm);
}

Progress ChannelPlayer::verify(double time_s, const ChannelOutput& seen) noexcept {
  const Verify& verify = step_->verify;
  switch (window_.observe(time_s, usable(verify, seen), evident(verify, seen))) {
    case EvidenceWindow::Verdict::verified:
      verified_ = true;
      return pass();
    case EvidenceWindow::Verdict::refuted:
      failure_ = GripResult::no_part;
      return Progress::failed;
    case EvidenceWindow::Verdict::pending:
      break;
  }
  return Progress::pending;
}

/// Executes the end of a release step. After the purge, waits until the finger is at the displacement that
/// the free-motion model predicts. Without displacement feedback, the step passes after the purge.
Progress ChannelPlayer::release(double time_s) noexcept {
  if (time_s < stage_end_s_) return Progress::pending;
  stage_ = Stage::free;
  const bool free = std::isfinite(shortfall_mm_) && !contact_.touching();
  return !traits_.displacement_used || free ? pass() : Progress::pending;
}

void ChannelPlayer::watch_from(double time_s, double interval_s) noexcept {
  const bool pressure = held_by_.by == VerifyBy::pressure;
  const bool position = held_by_.by == VerifyBy::position;
  hold_.start(time_s, interval_s,
              pressure   ? (held_by_.below() ? -held_by_.pressure_max_kpa : held_by_.pressure_min_kpa)
              : position ? 0.5
                         : 0.5 * traits_.margin_mm);
}

bool ChannelPlayer::watch(double time_s, const ChannelOutput& seen) noexcept {
  if (result_ != GripResult::holding) return false;
  const bool inside = seen.displacement_mm >= held_by_.displacement_min_mm &&
                      seen.displacement_mm <= held_by_.displacement_max_mm;
  double evidence = inside ? shortfall_mm_ : 0;
  if (held_by_.by == VerifyBy::pressure) {
    evidence = held_by_.below() ? -seen.pressure_kpa : seen.pressure_kpa;
  } else if (held_by_.by == VerifyBy::position) {
    evidence = inside ? 1 : 0;
  }
  return hold_.observe(time_s, usable(held_by_, seen), evidence);
}

ChannelDemand ChannelPlayer::demand(double time_s) const noexcept {
  ChannelDemand demand;
  demand.mode = mode_;
  demand.pressure_kpa = pressure_kpa_;
  demand.reference = &displacement_;
  demand.time_s = time_s;
  demand.plan = plan_;
  demand.plan_origin_s = plan_origin_s_;
  const bool watched = step_ != nullptr && (step_->kind == StepKind::grip || step_->kind == StepKind::hold ||
                                            (step_->on_contact != OnContact::ignore && closing_));
  demand.feedback_held = contact_.touching() && (watched || result_ == GripResult::holding);
  demand.pressure_max_kpa = bounds_.pressure_max_kpa;
  demand.squeeze_max_kpa = bounds_.squeeze_max_kpa;
  return demand;
}

}  // namespace softgrip::control
