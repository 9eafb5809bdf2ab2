#include "control/tick/channel_controller.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "control/elements/lag_share.h"
#include "control/feedforward/invertibility.h"

namespace softgrip::control {
namespace {

using DemandMode = ChannelDemand::Mode;

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();
/// Time constant with which the offset of the model follows the finger during resynchronisation [s].
constexpr double follow_time_s = 0.1;
/// A finger counts as settled after its residual has stayed within the noise for this time [s].
constexpr double settled_after_s = 0.2;
/// Largest residual of a settled finger, in standard deviations of the sensor's noise.
constexpr double settled_sigma = 4;
/// Time constant of the filter that removes the noise of the reading from ChannelOutput::free_kpa [s].
constexpr double need_filter_s = 0.03;
/// A limit that changes the command by at most this pressure is not reported [kPa].
constexpr double unnoticed_kpa = 0.5;
/// Largest number of missed ticks for which the model is advanced after a gap. After a longer gap, the model
/// restarts at rest under the present command.
constexpr std::int64_t most_ticks = 1000;
/// Longest gap after which a plan is continued [ticks]. After a longer gap, the feedforward restarts.
constexpr std::int64_t most_planned_ticks = 10;

FeedforwardSettings accepted(const ChannelSettings& settings, double tick_s) {
  FeedforwardSettings feedforward = settings.feedforward;
  if (!check_feedforward(settings.model, feedforward, settings.limits, tick_s)) {
    feedforward.kind = FeedforwardKind::none;
  }
  return feedforward;
}

}  // namespace

ChannelController::ChannelController(const ChannelSettings& settings, double tick_s)
    : tick_s_(tick_s),
      limits_(settings.limits),
      noise_mm_(settings.health.noise_mm),
      need_share_(lag_share(tick_s, need_filter_s)),
      displacement_used_(settings.displacement_used),
      running_(settings.model, tick_s, settings.feedforward.extra_latency_s, settings.plausibility.max_age_s),
      curve_(settings.model, settings.limits),
      feedforward_(settings.model, accepted(settings, tick_s), settings.limits, tick_s),
      pid_(settings.pid, tick_s),
      plausibility_(settings.plausibility),
      jumps_(settings.plausibility),
      health_(settings.health, tick_s) {}

void ChannelController::start(double command_kpa, ChannelOutput& channel) noexcept {
  channel = {};
  channel.command_kpa = limit(limits_, command_kpa, command_kpa, 0).command_kpa;
  channel.safe_kpa = channel.free_kpa = channel.command_kpa;
  channel.displacement_mm = channel.pressure_kpa = channel.temperature_c =
      not_known;  // a value that was never read is NaN, because 0 would look like a reading
  running_.reset(channel.command_kpa);
  plausibility_.reset();
  jumps_.reset();
  health_.reset();
  loop_ = Loop::stopped;
  sequence_ = 0;
  offset_mm_ = 0;
  settled_ticks_.reset();
}

void ChannelController::tick(const ChannelInput& input, ChannelOutput& channel) noexcept {
  const std::int64_t ticks = advance(input.now, channel.command_kpa);
  const bool is_new = input.reading.sequence != sequence_;
  sequence_ = input.reading.sequence;
  const bool has_reading = displacement_used_ && channel.validity == model::Validity::valid;
  const double predicted_mm = take_reading(input, channel);
  if (is_new && displacement_used_) watch_jumps(input.reading, predicted_mm, channel);
  follow_finger(input.resynchronise, predicted_mm, channel);
  channel.offset_mm = offset_mm_;
  watch_model(input, predicted_mm, is_new, channel);
  channel.shortfall_mm = has_reading ? -channel.residual_mm : not_known;
  weigh(predicted_mm, channel);
  send(input.demand, request(input.demand, ticks, channel), channel);
}

/// Computes the free-motion pressure and the gripping pressure. The free-motion pressure is the lower of two
/// values: the pressure of the first loading, and the pressure in the present state of the model. Creep and
/// hysteresis can make the second value lower than the first. The pressure of a moving finger is higher than
/// the pressure that the finger needs at rest. If an object stops the finger, the difference between the two
/// pressures becomes gripping pressure.
void ChannelController::weigh(double predicted_mm, ChannelOutput& channel) noexcept {
  channel.squeeze_kpa = not_known;
  if (!displacement_used_ || channel.validity != model::Validity::valid) return;
  const double first_way_kpa = curve_.command_kpa(channel.displacement_mm - offset_mm_);
  const double less_kpa =
      std::min(0.0, running_.pressure_kpa(channel.age_s) - curve_.pressure_kpa(predicted_mm));
  channel.free_kpa += need_share_ * (first_way_kpa + less_kpa - channel.free_kpa);
  channel.squeeze_kpa = curve_.command_kpa(predicted_mm) - first_way_kpa;
}

void ChannelController::send(const ChannelDemand& demand, double wanted_kpa,
                             ChannelOutput& channel) noexcept {
  const bool bounded = std::isfinite(demand.squeeze_max_kpa);
  const double squeezed_kpa = bounded ? channel.free_kpa + demand.squeeze_max_kpa : no_ceiling;
  const double ceiling_kpa = std::min(squeezed_kpa, demand.pressure_max_kpa);
  const LimitedCommand limited = limit(limits_, wanted_kpa, channel.command_kpa, tick_s_, ceiling_kpa);
  if (tracking()) pid_.sent(limited.command_kpa);
  channel.command_kpa = limited.command_kpa;
  channel.saturated = limited.saturated;
  channel.slewing = limited.slewing;
  channel.request_invalid = limited.invalid;
  const bool bound = limited.capped || wanted_kpa > limits_.pressure_max_kpa;
  if (bound && wanted_kpa > std::min(ceiling_kpa, limits_.pressure_max_kpa) + unnoticed_kpa) {
    channel.bound_by = limits_.pressure_max_kpa <= ceiling_kpa   ? BindingLimit::rig_pressure
                       : demand.pressure_max_kpa <= squeezed_kpa ? BindingLimit::step_pressure
                                                                 : BindingLimit::step_squeeze;
    return;
  }
  // During a vent, the command is meant to move at the slew limit. Therefore, the slew limit is not reported.
  const double behind_kpa = in_range(limits_, wanted_kpa) - limited.command_kpa;
  const bool slewed = limited.slewing && demand.mode != DemandMode::vent;
  channel.bound_by = !slewed || std::abs(behind_kpa) <= unnoticed_kpa ? BindingLimit::none
                     : behind_kpa > 0                                 ? BindingLimit::rig_slew_up
                                                                      : BindingLimit::rig_slew_down;
}

/// Advances the model to `now` and returns the number of ticks since the last call.
std::int64_t ChannelController::advance(Nanoseconds now, double command_kpa) noexcept {
  std::int64_t ticks = 1;
  if (loop_ == Loop::stopped) {
    loop_ = Loop::open;
  } else {
    ticks = std::max<std::int64_t>(1, std::llround(static_cast<double>(now - last_now_) * 1e-9 / tick_s_));
    if (ticks > most_ticks) {
      running_.reset(command_kpa);
    } else {
      for (std::int64_t i = 0; i < ticks; ++i) running_.advance(command_kpa);
    }
    if (ticks > most_planned_ticks) loop_ = Loop::open;
  }
  last_now_ = now;
  return ticks;
}

/// Takes over a reading, and returns the reading that the model predicts without its offset [mm].
double ChannelController::take_reading(const ChannelInput& input, ChannelOutput& channel) noexcept {
  const model::Reading& reading = input.reading;
  const bool none_yet = reading.validity == model::Validity::none_yet;
  channel.age_s = none_yet ? 0 : std::max(0.0, static_cast<double>(input.now - reading.sampled_at) * 1e-9);
  const double predicted_mm = running_.reading_mm(channel.age_s);
  channel.validity = plausibility_.judge(reading, input.now, channel.command_kpa, predicted_mm);
  channel.stands_still = plausibility_.stands_still();
  const bool valid = channel.validity == model::Validity::valid;
  if (valid) channel.displacement_mm = reading.displacement_mm;
  channel.pressure_kpa = reading.pressure_kpa;
  channel.temperature_c = reading.temperature_c;
  channel.displacement_beyond =
      displacement_used_ && valid && displacement_beyond(limits_, channel.displacement_mm);
  return predicted_mm;
}

/// Processes a reading to detect a sensor that jumps back and forth. A reading that the plausibility check
/// rejects as a jump is processed too.
void ChannelController::watch_jumps(const model::Reading& reading, double predicted_mm,
                                    ChannelOutput& channel) noexcept {
  if (reading.validity == model::Validity::valid && std::isfinite(reading.displacement_mm)) {
    jumps_.observe(reading.sampled_at, reading.displacement_mm, predicted_mm);
  }
  channel.unsteady = jumps_.unsteady();
  channel.jump_mm = jumps_.last_jump_mm();
}

void ChannelController::follow_finger(bool wanted, double predicted_mm, ChannelOutput& channel) noexcept {
  channel.synchronised = wanted && !displacement_used_;
  if (!wanted) {
    settled_ticks_.reset();
    return;
  }
  if (!displacement_used_) return;
  if (channel.validity != model::Validity::valid) {
    if (settled_ticks_) settled_ticks_ = 0;
    return;
  }
  const double difference_mm = channel.displacement_mm - predicted_mm;
  if (!settled_ticks_) {
    offset_mm_ = difference_mm;
    settled_ticks_ = 0;
  }
  const double gap_mm = difference_mm - offset_mm_;
  offset_mm_ += lag_share(tick_s_, follow_time_s) * gap_mm;
  settled_ticks_ = std::abs(gap_mm) <= settled_sigma * noise_mm_ ? *settled_ticks_ + 1 : 0;
  channel.synchronised = static_cast<double>(*settled_ticks_) * tick_s_ >= settled_after_s;
}

void ChannelController::watch_model(const ChannelInput& input, double predicted_mm, bool is_new,
                                    ChannelOutput& channel) noexcept {
  const bool valid = channel.validity == model::Validity::valid;
  channel.residual_mm = valid ? channel.displacement_mm - predicted_mm - offset_mm_ : not_known;
  const bool counts = displacement_used_ && valid && is_new && input.free_motion && !input.resynchronise;
  channel.health_changed = counts ? health_.observe(channel.residual_mm) : health_.skip();
  channel.health = health_.state();
  channel.health_rms_mm = health_.rms_mm();
}

/// Returns the command that the demand requests, before the limits [kPa].
double ChannelController::request(const ChannelDemand& demand, std::int64_t ticks,
                                  ChannelOutput& channel) noexcept {
  const bool tracks = demand.mode == DemandMode::displacement && demand.reference != nullptr;
  if (tracks) return track(demand, ticks, channel);
  loop_ = Loop::open;
  channel.reference_mm = not_known;
  channel.feedforward_kpa = channel.feedback_kpa = 0;
  channel.reference_clamped = channel.out_of_reach = false;
  switch (demand.mode) {
    case DemandMode::vent:
      return resting_kpa(limits_);
    case DemandMode::pressure:
      return demand.pressure_kpa;
    case DemandMode::hold:
    case DemandMode::displacement:
      break;
  }
  return channel.command_kpa;
}

double ChannelController::track(const ChannelDemand& demand, std::int64_t ticks,
                                ChannelOutput& channel) noexcept {
  const bool entering = !tracking();
  FeedforwardQuery query{.reference = demand.reference,
                         .time_s = demand.time_s,
                         .offset_mm = offset_mm_,
                         .plan = demand.plan,
                         .plan_origin_s = demand.plan_origin_s};
  if (entering) {
    feedforward_.enter(running_, query, channel.command_kpa);
    ticks = 1;
  }
  FeedforwardStep planned;
  for (std::int64_t late = ticks - 1; late >= 0; --late) {
    query.time_s = demand.time_s - static_cast<double>(late) * tick_s_;
    planned = feedforward_.step(query);
  }
  channel.feedforward_kpa = planned.pressure_kpa;
  channel.out_of_reach = planned.out_of_reach;

  const LimitedReference now = limit_reference(limits_, demand.reference->value_at(demand.time_s));
  channel.reference_mm = now.reference_mm;
  channel.reference_clamped = now.clamped;
  const bool released = loop_ == Loop::held && !demand.feedback_held;
  if (entering || released) pid_.align(channel.command_kpa);
  loop_ = demand.feedback_held ? Loop::held : Loop::closed;
  if (loop_ == Loop::closed && displacement_used_ && channel.validity == model::Validity::valid) {
    // The control error is the reference at the time of the reading minus the reading.
    const double then_mm =
        limit_reference(limits_, demand.reference->value_at(demand.time_s - channel.age_s)).reference_mm;
    channel.feedback_kpa = pid_.step(then_mm, channel.displacement_mm, planned.pressure_kpa);
  } else {
    channel.feedback_kpa = pid_.hold(planned.pressure_kpa);
  }
  return channel.feedforward_kpa + channel.feedback_kpa;
}

}  // namespace softgrip::control
