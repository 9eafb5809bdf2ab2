#include "control/feedforward_kinds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

namespace softgrip::control {
namespace {

/// How long the difference between model and reference at the start of tracking takes to fade out.
constexpr double fade_s = 0.5;

/// The value of a parameter of the first block with that id, or nothing.
std::optional<double> value_in(const model::Model& model, std::string_view id, std::string_view parameter) {
  const std::optional<std::size_t> position = model::position_of(model, id);
  if (!position) return std::nullopt;
  const model::BlockSpec& block = model.blocks[*position];
  return block.values[model::find_parameter(block, parameter).value()];
}

model::Model bouc_wen_of(const model::Model& model) {
  return model::only(model, [](const model::BlockInfo& info) { return info.id == "bouc_wen"; });
}

}  // namespace

BoucWenFeedforward::BoucWenFeedforward(const model::Model& model, const LimitSettings& limits, double tick_s)
    : limits_(limits), inverse_(bouc_wen_of(model), tick_s) {}

void BoucWenFeedforward::enter(const RunningModel& running, const FeedforwardQuery&, double) noexcept {
  // What it did while nobody asked: one stretch from where it was. The hysteresis forgets the rest.
  inverse_.advance(running.pressure_kpa());
}

FeedforwardStep BoucWenFeedforward::step(const FeedforwardQuery& query) noexcept {
  const double target_mm =
      limit_reference(limits_, query.reference->at(query.time_s).value).reference_mm - query.offset_mm;
  const auto solution = inverse_.solve(target_mm, limits_.pressure_min_kpa, limits_.pressure_max_kpa);
  inverse_.advance(solution.pressure_kpa);
  return {solution.pressure_kpa, !solution.reached};
}

FullModelFeedforward::FullModelFeedforward(const model::Model& model, const FeedforwardSettings& settings,
                                           const LimitSettings& limits, double tick_s)
    : limits_(limits),
      tick_s_(tick_s),
      ceiling_kpa_(std::min(
          limits.pressure_max_kpa,
          value_in(model, "pressure_saturation", "limit_kpa").value_or(std::numeric_limits<double>::max()))),
      lag_s_(value_in(model, "valve_lag", "time_constant_s").value_or(0)),
      lag_share_(lag_s_ > 0 ? -std::expm1(-tick_s / lag_s_) : 1),
      preview_s_(tick_s + dead_time_s(model) + settings.extra_latency_s),
      inverse_(body_of(model), tick_s) {}

ReferencePoint FullModelFeedforward::target(const FeedforwardQuery& query) const noexcept {
  const double then_s = query.time_s + preview_s_;
  ReferencePoint point = query.reference->at(then_s);
  const LimitedReference inside = limit_reference(limits_, point.value);
  if (inside.clamped) point = {inside.reference_mm, 0, 0};
  point.value -= query.offset_mm;
  return point;
}

FullModelFeedforward::Bracket FullModelFeedforward::bracket() const noexcept {
  const double now = inverse_.pressure_kpa();
  // Where the lowest and the highest command would bring the pressure, and no faster than the slew.
  const double lowest = now + lag_share_ * (limits_.pressure_min_kpa - now);
  const double highest = now + lag_share_ * (limits_.pressure_max_kpa - now);
  const double lower = std::max(lowest, now - limits_.slew_down_kpa_per_s * tick_s_);
  const double upper = std::min({highest, ceiling_kpa_, now + limits_.slew_up_kpa_per_s * tick_s_});
  return {std::min(lower, upper), upper};
}

double FullModelFeedforward::command_for(double pressure_kpa) const noexcept {
  const double now = inverse_.pressure_kpa();
  if (lag_s_ > 0) return now + (pressure_kpa - now) / lag_share_;
  return 0.5 * (now + pressure_kpa);
}

void FullModelFeedforward::enter(const RunningModel& running, const FeedforwardQuery& query,
                                 double command_kpa) noexcept {
  inverse_.take_over(running.body(), running.pressure_kpa());
  // Left alone, the pressure goes on toward the command; where the model then is, the fade begins.
  const double before_mm = inverse_.displacement_mm();
  const double now_kpa = inverse_.pressure_kpa();
  const double alone_mm = inverse_.displacement_at(now_kpa + lag_share_ * (command_kpa - now_kpa));
  const ReferencePoint wanted = target(query);
  fade_.start(query.time_s + preview_s_,
              {alone_mm - wanted.value, (alone_mm - before_mm) / tick_s_ - wanted.rate, 0});
  (void)fade_.ramp_for(0, fade_s);
}

FeedforwardStep FullModelFeedforward::step(const FeedforwardQuery& query) noexcept {
  const double wanted_mm = target(query).value + fade_.at(query.time_s + preview_s_).value;
  const Bracket within = bracket();
  const auto solution = inverse_.solve(wanted_mm, within.lower_kpa, within.upper_kpa);
  const double command_kpa = command_for(solution.pressure_kpa);
  inverse_.advance(solution.pressure_kpa);
  return {std::clamp(command_kpa, limits_.pressure_min_kpa, limits_.pressure_max_kpa), !solution.reached};
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
  }
}

void Feedforward::enter(const RunningModel& running, const FeedforwardQuery& query,
                        double command_kpa) noexcept {
  std::visit([&](auto& kind) { kind.enter(running, query, command_kpa); }, kind_);
}

FeedforwardStep Feedforward::step(const FeedforwardQuery& query) noexcept {
  return std::visit([&](auto& kind) { return kind.step(query); }, kind_);
}

double Feedforward::preview_s() const noexcept {
  return std::visit([](const auto& kind) { return kind.preview_s(); }, kind_);
}

}  // namespace softgrip::control
