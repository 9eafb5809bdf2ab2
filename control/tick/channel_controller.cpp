#include "control/tick/channel_controller.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "control/elements/plausibility.h"
#include "control/feedforward/feedforward_kinds.h"
#include "control/feedforward/invertibility.h"
#include "control/feedforward/running_model.h"

namespace softgrip::control {
namespace {

using DemandMode = ChannelDemand::Mode;

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();
/// How fast the offset follows the finger while re-synchronising.
constexpr double follow_time_s = 0.1;
/// How long the residual must have stayed within the noise to call it settled.
constexpr double settled_after_s = 0.2;
/// The residual of a settled finger, in standard deviations of the sensor's noise.
constexpr double settled_sigma = 4;
/// Ticks that the model catches up at most after a gap; beyond it the channel starts from rest.
constexpr std::int64_t most_ticks = 1000;
/// Ticks that a plan is carried over at most; beyond it the feedforward begins anew.
constexpr std::int64_t most_planned_ticks = 10;

FeedforwardSettings accepted(const ChannelSettings& settings, double tick_s) {
  FeedforwardSettings feedforward = settings.feedforward;
  if (!check_feedforward(settings.model, feedforward, settings.limits, tick_s)) {
    feedforward.kind = FeedforwardKind::none;
  }
  return feedforward;
}

}  // namespace

struct ChannelController::Parts {
  Parts(const ChannelSettings& from, double tick)
      : tick_s(tick),
        limits(from.limits),
        noise_mm(from.health.noise_mm),
        displacement_used(from.displacement_used),
        running(from.model, tick, from.feedforward.extra_latency_s, from.plausibility.max_age_s),
        feedforward(from.model, accepted(from, tick), from.limits, tick),
        pid(from.pid, tick),
        plausibility(from.plausibility),
        health(from.health, tick) {}

  void advance(Nanoseconds now) noexcept;
  void take_reading(const ChannelInput& input, ChannelStep& out) noexcept;
  void follow_finger(bool wanted, ChannelStep& out) noexcept;
  void watch_model(const ChannelInput& input, ChannelStep& out) noexcept;
  double request(const ChannelDemand& demand, ChannelStep& out) noexcept;
  double track(const ChannelDemand& demand, ChannelStep& out) noexcept;

  double tick_s;
  LimitSettings limits;
  double noise_mm;
  bool displacement_used;
  RunningModel running;
  Feedforward feedforward;
  Pid pid;
  Plausibility plausibility;
  ModelHealth health;

  bool ticked = false;
  Nanoseconds last_now = 0;
  std::int64_t ticks = 1;  ///< since the tick before
  double command_kpa = 0;
  bool tracking = false;
  bool feedback_held = false;

  double displacement_mm = 0;  ///< the last valid reading
  double age_s = 0;
  bool reading_valid = false;
  bool reading_new = false;
  std::uint32_t sequence = 0;
  double predicted_mm = 0;  ///< by the model without offset, when the reading was sampled
  double offset_mm = 0;
  bool following = false;
  std::int64_t settled_ticks = 0;
};

void ChannelController::Parts::advance(Nanoseconds now) noexcept {
  ticks = 1;
  if (ticked) {
    ticks = std::max<std::int64_t>(1, std::llround(static_cast<double>(now - last_now) * 1e-9 / tick_s));
    if (ticks > most_ticks) {
      running.reset(command_kpa);
    } else {
      for (std::int64_t i = 0; i < ticks; ++i) running.advance(command_kpa);
    }
    if (ticks > most_planned_ticks) tracking = false;
  }
  ticked = true;
  last_now = now;
}

void ChannelController::Parts::take_reading(const ChannelInput& input, ChannelStep& out) noexcept {
  out.validity = plausibility.judge(input.reading, input.now, command_kpa);
  reading_valid = out.validity == model::Validity::valid;
  age_s = std::max(0.0, static_cast<double>(input.now - input.reading.sampled_at) * 1e-9);
  if (input.reading.validity == model::Validity::none_yet) age_s = 0;
  out.age_s = age_s;
  predicted_mm = running.reading_mm(age_s);
  reading_new = reading_valid && input.reading.sequence != sequence;
  sequence = input.reading.sequence;
  if (reading_valid) displacement_mm = input.reading.displacement_mm;
  out.displacement_mm = displacement_mm;
  out.displacement_beyond =
      displacement_used && reading_valid && displacement_beyond(limits, displacement_mm);
}

void ChannelController::Parts::follow_finger(bool wanted, ChannelStep& out) noexcept {
  if (!wanted) {
    following = false;
    return;
  }
  if (!displacement_used) {
    out.synchronised = true;
    return;
  }
  if (!reading_valid) {
    settled_ticks = 0;
    return;
  }
  const double difference_mm = displacement_mm - predicted_mm;
  if (!following) {
    following = true;
    offset_mm = difference_mm;
    settled_ticks = 0;
  }
  const double gap_mm = difference_mm - offset_mm;
  offset_mm += -std::expm1(-tick_s / follow_time_s) * gap_mm;
  settled_ticks = std::abs(gap_mm) <= settled_sigma * noise_mm ? settled_ticks + 1 : 0;
  out.synchronised = static_cast<double>(settled_ticks) * tick_s >= settled_after_s;
}

void ChannelController::Parts::watch_model(const ChannelInput& input, ChannelStep& out) noexcept {
  out.residual_mm = reading_valid ? displacement_mm - predicted_mm - offset_mm : not_known;
  const bool counts = displacement_used && reading_new && input.free_motion && !input.resynchronise;
  out.health_changed = counts ? health.observe(out.residual_mm) : health.skip();
  out.health = health.state();
  out.health_rms_mm = health.rms_mm();
}

double ChannelController::Parts::track(const ChannelDemand& demand, ChannelStep& out) noexcept {
  const bool entering = !tracking;
  FeedforwardQuery query{demand.reference, demand.time_s, offset_mm, demand.plan, demand.plan_origin_s};
  if (entering) {
    feedforward.enter(running, query, command_kpa);
    ticks = 1;
  }
  FeedforwardStep planned;
  for (std::int64_t late = ticks - 1; late >= 0; --late) {
    query.time_s = demand.time_s - static_cast<double>(late) * tick_s;
    planned = feedforward.step(query);
  }
  tracking = true;
  out.feedforward_kpa = planned.pressure_kpa;
  out.out_of_reach = planned.out_of_reach;

  const LimitedReference now = limit_reference(limits, demand.reference->at(demand.time_s).value);
  out.reference_mm = now.reference_mm;
  out.reference_clamped = now.clamped;
  if (entering || (feedback_held && !demand.feedback_held)) pid.align(command_kpa);
  feedback_held = demand.feedback_held;
  if (reading_valid && displacement_used && !feedback_held) {
    // The error is taken where the reading was: against the reference of that time, not of now.
    const double then_mm =
        limit_reference(limits, demand.reference->at(demand.time_s - age_s).value).reference_mm;
    out.feedback_kpa = pid.step(then_mm, displacement_mm, planned.pressure_kpa);
  } else {
    out.feedback_kpa = pid.hold(planned.pressure_kpa);
  }
  return out.feedforward_kpa + out.feedback_kpa;
}

double ChannelController::Parts::request(const ChannelDemand& demand, ChannelStep& out) noexcept {
  out.reference_mm = not_known;
  const bool tracks = demand.mode == DemandMode::displacement && demand.reference != nullptr;
  if (tracks) return track(demand, out);
  tracking = false;
  feedback_held = false;
  switch (demand.mode) {
    case DemandMode::vent:
      return limits.pressure_min_kpa;
    case DemandMode::pressure:
      return demand.pressure_kpa;
    case DemandMode::hold:
    case DemandMode::displacement:
      break;
  }
  return command_kpa;
}

ChannelController::ChannelController(const ChannelSettings& settings, double tick_s)
    : parts_(std::make_unique<Parts>(settings, tick_s)) {
  start(settings.limits.pressure_min_kpa);
}
ChannelController::ChannelController(ChannelController&&) noexcept = default;
ChannelController& ChannelController::operator=(ChannelController&&) noexcept = default;
ChannelController::~ChannelController() = default;

void ChannelController::start(double command_kpa) noexcept {
  Parts& p = *parts_;
  p.command_kpa = limit(p.limits, command_kpa, command_kpa, 0).command_kpa;
  p.running.reset(p.command_kpa);
  p.plausibility.reset();
  p.health.reset();
  p.ticked = p.tracking = p.feedback_held = p.following = false;
  p.reading_valid = p.reading_new = false;
  p.sequence = 0;
  p.offset_mm = p.displacement_mm = 0;
}

ChannelStep ChannelController::tick(const ChannelInput& input) noexcept {
  Parts& p = *parts_;
  ChannelStep out;
  p.advance(input.now);
  p.take_reading(input, out);
  p.follow_finger(input.resynchronise, out);
  p.watch_model(input, out);
  const double wanted_kpa = p.request(input.demand, out);
  const LimitedCommand limited = limit(p.limits, wanted_kpa, p.command_kpa, p.tick_s);
  p.command_kpa = limited.command_kpa;
  if (p.tracking) p.pid.sent(limited.command_kpa);
  out.command_kpa = limited.command_kpa;
  out.saturated = limited.saturated;
  out.slewing = limited.slewing;
  out.request_invalid = limited.invalid;
  return out;
}

double ChannelController::command_kpa() const noexcept {
  return parts_->command_kpa;
}
double ChannelController::preview_s() const noexcept {
  return parts_->feedforward.preview_s();
}
double ChannelController::free_displacement_mm() const noexcept {
  return parts_->predicted_mm + parts_->offset_mm;
}
double ChannelController::offset_mm() const noexcept {
  return parts_->offset_mm;
}
void ChannelController::change_gains(const PidSettings& settings) noexcept {
  parts_->pid.change(settings);
}

}  // namespace softgrip::control
