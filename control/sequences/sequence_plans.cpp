#include "control/sequences/sequence_plans.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "control/feedforward/feedforward_kinds.h"
#include "control/sequences/planner.h"
#include "control/tick/channel_player.h"

namespace softgrip::control {
namespace {

/// Longest time that a plan covers after the end of its reference, for example during a hold step [s]. In
/// this time, the plan has no other effect than to compensate creep.
constexpr double longest_hold_s = 20;
/// If the displacement in a plan differs from the reference by more than this distance, plan_steps() reports
/// the plan [mm].
constexpr double missed_mm = 0.2;

bool planned(const ChannelSettings& channel) {
  return channel.feedforward.kind == FeedforwardKind::planned;
}

/// The expected motion of one channel in a sequence.
class Walk {
 public:
  /// @param plans  true: compute the plans; false: compute only the durations of the plans.
  Walk(const ChannelSettings& channel, double margin_mm, double tick_s, bool plans)
      : planned_(planned(channel)),
        rest_kpa_(resting_kpa(channel.limits)),
        ahead_s_(planned_ ? plan_ahead_s(channel.model, channel.feedforward, tick_s) : 0),
        player_({.margin_mm = margin_mm,
                 .rest_kpa = rest_kpa_,
                 .preview_s = planned_ ? ahead_s_ + plan_lead_s : 0}) {
    if (planned_ && plans) planner_.emplace(channel.model, channel.limits, tick_s);
  }

  /// Begins a step of the sequence and returns the time at which the result of this step is expected.
  double begin(PreparedStep& step, double time_s) {
    if (step.step.kind == StepKind::hold) {
      return time_s + (std::isfinite(step.step.hold_s) ? step.step.hold_s : longest_hold_s);
    }
    step_ = &step;
    since_s_ = time_s;
    ChannelOutput seen;
    seen.validity = model::Validity::valid;
    seen.command_kpa = planner_ ? planner_->command_kpa() : rest_kpa_;
    seen.displacement_mm = planner_ ? planner_->displacement_mm() : 0;
    player_.begin(step.step, nullptr, time_s, seen);
    const bool grips = step.step.kind == StepKind::grip;
    return player_.motion_end_s() + step.step.settle_s + (grips ? step.step.verify.window_s : 0) +
           step.step.purge_s;
  }

  [[nodiscard]] PreparedStep* step() const noexcept { return step_; }

  /// Returns the duration of the motion that must be planned for the present step [s]; 0 if there is nothing
  /// to plan. The next step of the channel begins at `time_s`.
  [[nodiscard]] double planned_s(double time_s) const {
    if (!planned_ || step_ == nullptr) return 0;
    const ChannelDemand demand = player_.demand(since_s_);
    if (demand.mode != ChannelDemand::Mode::displacement) return 0;
    return std::min({time_s, vent_s(), demand.reference->end_s() + longest_hold_s}) - since_s_;
  }

  /// Moves the channel from the start of its present step to `time_s`, the start of its next step. For a step
  /// to a displacement, returns the plan. For a step to a pressure, moves the model with the commands of the
  /// step and returns an empty plan.
  PressurePlan go_on_until(double time_s, const std::stop_token& stop) {
    PressurePlan plan;
    if (planner_ && step_ != nullptr) {
      if (const double duration_s = planned_s(time_s); duration_s > 0) {
        const double from_s = since_s_ + ahead_s_;
        plan = planner_->plan(*player_.demand(since_s_).reference, from_s, from_s + duration_s, stop);
        plan.begin_s = since_s_;
      } else {
        planner_->drive([&](double t) { return player_.pressure_at(since_s_ + t); },
                        std::min(time_s, vent_s()) - since_s_);
      }
      planner_->drive([&](double) { return rest_kpa_; }, time_s - vent_s());
    }
    step_ = nullptr;
    return plan;
  }

 private:
  /// Returns the time at which a release step starts to vent; infinite for all other steps.
  [[nodiscard]] double vent_s() const {
    return step_->step.kind == StepKind::release ? player_.motion_end_s() : infinite;
  }

  bool planned_;
  double rest_kpa_;
  double ahead_s_;
  ChannelPlayer player_;
  std::optional<Planner> planner_;
  PreparedStep* step_ = nullptr;  ///< the present step of the channel
  double since_s_ = 0;
};

/// Returns true if two channels have equal settings, models and steps, so that one plan serves both channels.
bool same_way(const RigSettings& settings, const PreparedSequence& sequence, std::size_t a, std::size_t b) {
  const ChannelSettings& one = settings.channels[a];
  const ChannelSettings& other = settings.channels[b];
  const LimitSettings& x = one.limits;
  const LimitSettings& y = other.limits;
  const auto together = [&](const PreparedStep& step) {
    return (step.channels >> a & 1U) == (step.channels >> b & 1U);
  };
  return planned(one) && planned(other) && one.model == other.model &&
         one.feedforward.extra_latency_s == other.feedforward.extra_latency_s &&
         x.pressure_min_kpa == y.pressure_min_kpa && x.pressure_max_kpa == y.pressure_max_kpa &&
         resting_kpa(x) == resting_kpa(y) && x.slew_up_kpa_per_s == y.slew_up_kpa_per_s &&
         x.slew_down_kpa_per_s == y.slew_down_kpa_per_s && x.displacement_min_mm == y.displacement_min_mm &&
         x.displacement_max_mm == y.displacement_max_mm &&
         std::all_of(sequence.steps.begin(), sequence.steps.end(), together);
}

class Planning {
 public:
  Planning(PreparedSequence& sequence, const RigSettings& settings, bool plans, const std::stop_token& stop)
      : sequence_(sequence),
        plans_(plans),
        stop_(stop),
        like_(settings.channels.size()),
        planned_s_(like_.size()) {
    for (std::size_t i = 0; i < like_.size(); ++i) {
      like_[i] = i;
      for (std::size_t j = 0; j < i && like_[i] == i; ++j) {
        if (same_way(settings, sequence, j, i)) like_[i] = j;
      }
      walks_.push_back(std::make_unique<Walk>(settings.channels[i], settings.detection.margin_mm,
                                              1 / settings.rate_hz, plans));
    }
  }

  std::vector<MissedPlan> run() {
    double time_s = 0;
    for (PreparedStep& step : sequence_.steps) {
      double end_s = time_s;
      for (std::size_t i = 0; i < walks_.size(); ++i) {
        if (like_[i] != i || (step.channels >> i & 1U) == 0) continue;
        if (step.step.kind != StepKind::hold) finish(i, time_s);
        end_s = std::max(end_s, walks_[i]->begin(step, time_s));
      }
      time_s = end_s;
    }
    for (std::size_t i = 0; i < walks_.size(); ++i) {
      if (like_[i] == i) finish(i, time_s);
    }
    sequence_.planned_s = *std::max_element(planned_s_.begin(), planned_s_.end());
    return std::move(missed_);
  }

 private:
  void finish(std::size_t channel, double time_s) {
    planned_s_[channel] += walks_[channel]->planned_s(time_s);
    const PreparedStep* const step = walks_[channel]->step();
    const PressurePlan plan = walks_[channel]->go_on_until(time_s, stop_);
    if (!plans_ || plan.empty()) return;
    const auto k = static_cast<std::size_t>(step - sequence_.steps.data());
    std::vector<PressurePlan>& plans = sequence_.steps[k].plans;
    plans.resize(walks_.size());
    for (std::size_t i = channel; i < walks_.size(); ++i) {
      if (like_[i] != channel) continue;
      plans[i] = plan;
      if (plan.worst_mm > missed_mm) missed_.push_back({k, i, plan.rmse_mm, plan.worst_mm});
    }
  }

  PreparedSequence& sequence_;
  bool plans_;
  const std::stop_token& stop_;
  std::vector<std::size_t> like_;  ///< for each channel, the first channel that has the same motion
  std::vector<double> planned_s_;
  std::vector<std::unique_ptr<Walk>> walks_;
  std::vector<MissedPlan> missed_;
};

}  // namespace

std::vector<MissedPlan> plan_steps(PreparedSequence& sequence, const RigSettings& settings,
                                   const std::stop_token& stop) {
  if (std::none_of(settings.channels.begin(), settings.channels.end(), planned)) return {};
  static_cast<void>(Planning(sequence, settings, false, stop).run());
  if (sequence.planned_s > most_planned_s) return {};
  return Planning(sequence, settings, true, stop).run();
}

}  // namespace softgrip::control
