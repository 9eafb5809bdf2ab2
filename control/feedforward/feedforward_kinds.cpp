#include "control/feedforward/feedforward_kinds.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/blocks/asymmetric_bouc_wen.h"
#include "model/blocks/bouc_wen.h"
#include "model/blocks/pressure_saturation.h"
#include "model/dual.h"
#include "model/named.h"

namespace softgrip::control {
namespace {

/// Shortest time in which the difference between the plan and the reference fades out [s].
constexpr double fade_s = 0.5;
/// Peak acceleration and peak speed of a minimum-jerk motion over a distance of 1 in a time of 1.
constexpr double peak_acceleration = 5.774;
constexpr double peak_speed = 1.875;
/// If the pressure of the plan differs from the required pressure by more than this, the reference is
/// reported as out of reach.
constexpr double late_kpa = 1e-6;
/// If the displacement in a plan differs from the reference by more than this, the reference is reported as
/// out of reach.
constexpr double missed_mm = 0.2;
/// Largest difference between the first value of a reference and the first value of its plan [mm]. A plan
/// with a larger difference was computed for another motion, and is not used.
constexpr double off_plan_mm = 1;
/// Largest difference that rounding causes between the clock of the reference and the clock of the plan.
constexpr double clock_rounding_s = 1e-6;
/// Time in which the difference between the previous pressure and the first pressure of a new plan fades out.
constexpr double plan_fade_s = 3;

model::Model bouc_wen_of(const model::Model& model) {
  // The asymmetry of the hysteresis is a separate block. This block is kept, because it is a part of the
  // hysteresis element.
  return model::only(model, [](const model::BlockInfo& info) {
    return model::is<model::BoucWen, model::AsymmetricBoucWen, model::DuhemHysteresis>(info);
  });
}

/// Returns the displacement that the model must reach at `time_s`: the reference within the limits, minus the
/// offset [mm].
double wanted_mm(const LimitSettings& limits, const FeedforwardQuery& query, double time_s) noexcept {
  return limit_reference(limits, query.reference->value_at(time_s)).reference_mm - query.offset_mm;
}

}  // namespace

BoucWenFeedforward::BoucWenFeedforward(const model::Model& model, const LimitSettings& limits, double tick_s)
    : limits_(limits), inverse_(bouc_wen_of(model), tick_s) {}

void BoucWenFeedforward::enter(const RunningModel& running, const FeedforwardQuery&, double) noexcept {
  // The hysteresis does not depend on the rate of the pressure. Therefore, the pressure change since the last
  // call is applied as one segment. Reversals of the pressure since the last call are neglected.
  inverse_.advance(running.pressure_kpa());
}

FeedforwardStep BoucWenFeedforward::step(const FeedforwardQuery& query) noexcept {
  const double target_mm = wanted_mm(limits_, query, query.time_s);
  const auto solution = inverse_.solve(target_mm, limits_.pressure_min_kpa, limits_.pressure_max_kpa);
  inverse_.advance(solution.pressure_kpa);
  return {solution.pressure_kpa, !solution.reached};
}

FullModelFeedforward::FullModelFeedforward(const model::Model& model, const FeedforwardSettings& settings,
                                           const LimitSettings& limits, double tick_s)
    : limits_(limits),
      tick_s_(tick_s),
      ceiling_kpa_(std::min(limits.pressure_max_kpa, value_in<model::PressureSaturation>(model, "limit_kpa")
                                                         .value_or(std::numeric_limits<double>::max()))),
      valve_(model, tick_s),
      preview_s_(tick_s + dead_time_s(model) + settings.extra_latency_s),
      inverse_(body_of(model), tick_s) {
  // Estimates the speed and the acceleration of the finger at the slew limit. The immediate response to
  // pressure determines the speed, and the creep determines the acceleration.
  const model::Chain<double> body(body_of(model), {}, tick_s);
  const double at_once = body.peek(0.0, model::Dual<double>(0, 1)).v;
  const double after_tick = body.peek(tick_s, model::Dual<double>(0, 1)).v;
  const double slew = std::min(limits.slew_up_kpa_per_s, limits.slew_down_kpa_per_s);
  easy_mm_per_s_ = at_once * slew;
  easy_mm_per_s2_ = 2 * (after_tick - at_once) / tick_s * slew;
}

ReferencePoint FullModelFeedforward::target(const FeedforwardQuery& query) const noexcept {
  const double then_s = query.time_s + preview_s_;
  ReferencePoint point = query.reference->at(then_s);
  const LimitedReference inside = limit_reference(limits_, point.value);
  if (inside.clamped) point = {.value = inside.reference_mm};
  point.value -= query.offset_mm;
  return point;
}

double FullModelFeedforward::command_toward(double wanted_kpa) noexcept {
  const double now = inverse_.pressure_kpa();
  double next = wanted_kpa;
  const double time_constant_s = valve_.time_constant_s(now, wanted_kpa);
  if (time_constant_s > 0) {
    // `left` is the remaining distance to wanted_kpa if the pressure changes in this tick by the same amount
    // as wanted_kpa.
    const double along = std::clamp(wanted_kpa - last_wanted_kpa_, -limits_.slew_down_kpa_per_s * tick_s_,
                                    limits_.slew_up_kpa_per_s * tick_s_);
    const double left = wanted_kpa - now - along;
    const double brake =
        (left > 0 ? limits_.slew_down_kpa_per_s : limits_.slew_up_kpa_per_s) / time_constant_s;
    const double stoppable = tick_s_ * std::sqrt(2 * brake * std::abs(left));
    if (std::abs(left) > stoppable) next = now + along + std::copysign(stoppable, left);
  }
  last_wanted_kpa_ = wanted_kpa;
  const double ideal = valve_.command_for(now, next);
  return limit(limits_, ideal, command_kpa_, tick_s_).command_kpa;
}

void FullModelFeedforward::enter(const RunningModel& running, const FeedforwardQuery& query,
                                 double command_kpa) noexcept {
  inverse_.take_over(running.body(), running.pressure_kpa());
  valve_.take_over(running.valve());
  command_kpa_ = in_range(limits_, command_kpa);
  last_wanted_kpa_ = running.pressure_kpa();
  // The fade-out begins at the displacement that the model would reach after one tick in which the pressure
  // moves towards the present command.
  const double before_mm = inverse_.displacement_mm();
  ValveInverse alone = valve_;
  const double alone_kpa = std::min(alone.advance(running.pressure_kpa(), command_kpa), ceiling_kpa_);
  const double alone_mm = inverse_.displacement_at(alone_kpa);
  const ReferencePoint wanted = target(query);
  fade_from(alone_mm, (alone_mm - before_mm) / tick_s_, wanted, query.time_s + preview_s_);
  last_displacement_mm_ = before_mm;
  jumps_.start(wanted.value);
  held_ = false;
}

void FullModelFeedforward::fade_from(double displacement_mm, double speed_mm_per_s, const ReferencePoint& to,
                                     double then_s) noexcept {
  const double difference_mm = displacement_mm - to.value;
  const double distance_mm = std::abs(difference_mm);
  // The time `by_speed_s` applies to a finger that responds immediately, and `by_acceleration_s` to a finger
  // that creeps. The shorter of the two times is sufficient.
  const double by_speed_s = peak_speed * distance_mm / easy_mm_per_s_;
  const double by_acceleration_s = std::sqrt(peak_acceleration * distance_mm / easy_mm_per_s2_);
  fade_.start(then_s, {.value = difference_mm, .rate = speed_mm_per_s - to.rate});
  (void)fade_.ramp_for(0, std::max(fade_s, std::min(by_speed_s, by_acceleration_s)));
}

FeedforwardStep FullModelFeedforward::step(const FeedforwardQuery& query) noexcept {
  const double then_s = query.time_s + preview_s_;
  const double target_mm = wanted_mm(limits_, query, then_s);
  const double now_mm = inverse_.displacement_mm();
  const bool jumped = jumps_.jumps_to(target_mm);
  // A fade-out of less than a tick would only continue the present motion for one tick.
  if ((jumped || held_) && tick_s_ < fade_s) {
    const double going_mm = now_mm - last_displacement_mm_;
    fade_from(now_mm + going_mm, going_mm / tick_s_, target(query), then_s);
  }
  held_ = false;
  last_displacement_mm_ = now_mm;

  const auto solution =
      inverse_.solve(target_mm + fade_.value_at(then_s), limits_.pressure_min_kpa, ceiling_kpa_);
  command_kpa_ = command_toward(solution.pressure_kpa);
  advance();
  const bool late = std::abs(inverse_.pressure_kpa() - solution.pressure_kpa) > late_kpa;
  return {command_kpa_, late || !solution.reached};
}

void FullModelFeedforward::advance() noexcept {
  inverse_.advance(std::min(valve_.advance(inverse_.pressure_kpa(), command_kpa_), ceiling_kpa_));
}

void FullModelFeedforward::hold() noexcept {
  last_displacement_mm_ = inverse_.displacement_mm();
  advance();
  last_wanted_kpa_ = inverse_.pressure_kpa();
  held_ = true;
}

double plan_ahead_s(const model::Model& model, const FeedforwardSettings& settings, double tick_s) {
  return 0.5 * tick_s + dead_time_s(model) + settings.extra_latency_s;
}

PlannedFeedforward::PlannedFeedforward(const model::Model& model, const FeedforwardSettings& settings,
                                       const LimitSettings& limits, double tick_s)
    : limits_(limits),
      settled_(settled_line(model, limits)),
      tick_s_(tick_s),
      ahead_s_(plan_ahead_s(model, settings, tick_s)) {}

void PlannedFeedforward::enter(const RunningModel&, const FeedforwardQuery&, double command_kpa) noexcept {
  entering_ = true;
  last_kpa_ = command_kpa;
}

double PlannedFeedforward::unplanned_mm(const FeedforwardQuery& query, double wanted_mm,
                                        double then_s) const noexcept {
  double least_mm = std::numeric_limits<double>::max();
  // The clocks of the reference and of the plan can differ by a rounding error. At a jump of the reference, a
  // rounding error would select the wrong side of the jump. Therefore, the values on both sides of the jump
  // are compared.
  for (const double aside_s : {0.0, -clock_rounding_s, clock_rounding_s}) {
    const double on_plan_s = then_s - query.plan_origin_s + aside_s;
    const double planned_mm =
        limit_reference(limits_, query.plan->reference.value_at(on_plan_s)).reference_mm;
    const double difference_mm = wanted_mm - planned_mm;
    if (std::abs(difference_mm) < std::abs(least_mm)) least_mm = difference_mm;
  }
  return least_mm;
}

FeedforwardStep PlannedFeedforward::step(const FeedforwardQuery& query) noexcept {
  const double then_s = query.time_s + ahead_s_;
  const double target_mm = wanted_mm(limits_, query, then_s);
  const double aside_mm = query.plan != nullptr ? unplanned_mm(query, target_mm, then_s) : 0;
  const bool changed = entering_ || query.plan != plan_ || query.plan_origin_s != origin_s_;
  if (changed) on_plan_ = query.plan != nullptr && std::abs(aside_mm) <= off_plan_mm;
  const auto* const plan = on_plan_ ? query.plan : nullptr;
  const double source = plan != nullptr
                            ? plan->at(then_s - query.plan_origin_s) + aside_mm / settled_.gain_mm_per_kpa
                            : settled_.pressure_kpa(target_mm);
  if (changed) {
    entering_ = false;
    plan_ = query.plan;
    origin_s_ = query.plan_origin_s;
    difference_kpa_ = last_kpa_ - source;
    fade_left_s_ = plan_fade_s;
  }
  const double faded = source + difference_kpa_ * fade_left_s_ / plan_fade_s;
  fade_left_s_ = std::max(0.0, fade_left_s_ - tick_s_);
  last_kpa_ = in_range(limits_, faded);
  const bool missed = on_plan_ && plan_->miss_mm(then_s - origin_s_) > missed_mm;
  return {last_kpa_, missed || std::abs(faded - last_kpa_) > late_kpa};
}

Feedforward::Feedforward(const model::Model& model, const FeedforwardSettings& settings,
                         const LimitSettings& limits, double tick_s) {
  switch (settings.kind) {
    case FeedforwardKind::none:
      break;
    case FeedforwardKind::bouc_wen:
      kind_.emplace<BoucWenFeedforward>(model, limits, tick_s);
      break;
    case FeedforwardKind::full_model:
      kind_.emplace<FullModelFeedforward>(model, settings, limits, tick_s);
      break;
    case FeedforwardKind::planned:
      kind_.emplace<PlannedFeedforward>(model, settings, limits, tick_s);
      break;
  }
}

void Feedforward::enter(const RunningModel& running, const FeedforwardQuery& query,
                        double command_kpa) noexcept {
  std::visit([&](auto& kind) { kind.enter(running, query, command_kpa); }, kind_);
}

FeedforwardStep Feedforward::step(const FeedforwardQuery& query) noexcept {
  return std::visit([&](auto& kind) { return kind.step(query); }, kind_);
}

void Feedforward::hold() noexcept {
  if (auto* const full = std::get_if<FullModelFeedforward>(&kind_)) full->hold();
}

double Feedforward::preview_s() const noexcept {
  return std::visit([](const auto& kind) { return kind.preview_s(); }, kind_);
}

}  // namespace softgrip::control
