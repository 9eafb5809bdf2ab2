#include "control/tuning/tune.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "base/numbers.h"
#include "base/random.h"
#include "control/feedforward/running_model.h"
#include "control/tuning/gain_search.h"
#include "model/chain.h"

namespace softgrip::control {
namespace {

/// Search variables: ln kp, ln ki, derivative time [s]; a negative derivative time means a PID without
/// derivative.
using Point = GainPoint;

constexpr double filter_share = 0.125;
/// Smallest cost of a control loop whose sensitivity is above its bound [mm]. The cost increases with the
/// sensitivity.
constexpr double no_margin_mm = 100;
constexpr double most_error_mm = 50;

class Cost {
 public:
  explicit Cost(const TuneTask& task) : task_(task), tick_s_(1 / task.rate_hz) {
    for (int i = 0; i < task.draws; ++i) {
      fingers_.push_back(
          with_scatter(task.finger, task.mismatch, derived_seed(task.seed, static_cast<std::uint64_t>(i))));
    }
    if (task.channel.feedforward.kind != FeedforwardKind::planned) return;
    for (const double frequency : task.frequencies_hz) {
      plans_.push_back(plan_for(run_of(task.finger, frequency, {}, 0)));
    }
  }

  [[nodiscard]] PidSettings gains(const Point& x) const {
    PidSettings pid;
    pid.kp_kpa_per_mm = std::exp(x[0]);
    pid.ki_kpa_per_mm_s = std::exp(x[1]);
    const double derivative_s = std::max(0.0, x[2]);
    pid.kd_kpa_s_per_mm = derivative_s * pid.kp_kpa_per_mm;
    pid.derivative_filter_s = std::max(2 * tick_s_, filter_share * derivative_s);
    return pid;
  }

  double operator()(const Point& x) {
    ++evaluations;
    const PidSettings pid = gains(x);
    const double sensitivity = margins(pid).sensitivity;
    if (!(sensitivity <= task_.most_sensitivity)) {
      return no_margin_mm + std::min(no_margin_mm, sensitivity);
    }
    return rmse(pid, fingers_, task_.noise_mm);
  }

  /// Returns the worst stability margins over all simulated fingers.
  [[nodiscard]] LoopMargins margins(const PidSettings& pid) const {
    LoopMargins worst;
    worst.crossover_hz = 0.5 * task_.rate_hz;
    for (const model::Model& finger : fingers_) {
      const LoopMargins one =
          loop_margins(finger, pid, task_.channel.limits, tick_s_, tick_s_ + task_.exchange_s);
      worst.sensitivity = std::max(worst.sensitivity, one.sensitivity);
      worst.crossover_hz = std::min(worst.crossover_hz, one.crossover_hz);
      if (worst.sensitivity > task_.most_sensitivity) break;
    }
    return worst;
  }

  [[nodiscard]] double rmse(const PidSettings& pid, const std::vector<model::Model>& fingers,
                            double noise_mm) const {
    double squares = 0;
    for (std::size_t i = 0; i < fingers.size(); ++i) {
      for (std::size_t f = 0; f < task_.frequencies_hz.size(); ++f) {
        TrackingRun run = run_of(fingers[i], task_.frequencies_hz[f], pid, noise_mm);
        run.seed = derived_seed(task_.seed, 1000 + i);
        if (f < plans_.size()) run.plan = &plans_[f];
        const double one = std::min(most_error_mm, track(run).rmse_mm);
        squares += one * one;
      }
    }
    return std::sqrt(squares / static_cast<double>(fingers.size() * task_.frequencies_hz.size()));
  }

  [[nodiscard]] const std::vector<model::Model>& fingers() const { return fingers_; }
  int evaluations = 0;

 private:
  [[nodiscard]] TrackingRun run_of(const model::Model& finger, double frequency_hz, const PidSettings& pid,
                                   double noise_mm) const {
    TrackingRun run;
    run.settings = task_.channel;
    run.settings.pid = pid;
    run.finger = finger;
    run.rate_hz = task_.rate_hz;
    run.exchange_s = task_.exchange_s;
    run.mean_mm = task_.mean_mm;
    run.amplitude_mm = task_.amplitude_mm;
    run.frequency_hz = frequency_hz;
    run.noise_mm = noise_mm;
    run.settling_cycles = frequency_hz < 0.1 ? 0.25 : 0.5;
    run.measured_cycles = 1;
    return run;
  }

  const TuneTask& task_;
  double tick_s_;
  std::vector<model::Model> fingers_;
  std::vector<PressurePlan> plans_;
};

std::string limit_in_words(const TuneTask& task, const Tuned& tuned) {
  std::string text;
  if (tuned.sensitivity > 0.95 * task.most_sensitivity) {
    const auto lag = model::find_path(task.finger, "valve_lag.time_constant_s");
    text = "the stability margin: the sensitivity peak Ms is " + significant(tuned.sensitivity, 3) +
           " (at most " + significant(task.most_sensitivity, 3) + " is permitted), and " +
           significant(dead_time_s(task.finger), 3) + " s of dead time" +
           (lag ? " and " + significant(model::flat_values(task.finger)[*lag], 3) + " s of lag" : "") +
           " do not permit higher feedback gains";
  } else {
    text =
        "effects other than the stability margin, because higher feedback gains would not lower the error "
        "(the sensitivity peak Ms is " +
        significant(tuned.sensitivity, 3) + "; at most " + significant(task.most_sensitivity, 3) +
        " is permitted)";
  }
  const double floor = tuned.exact_mm;
  const double by_noise = tuned.noisy_mm - floor;
  const double by_mismatch = tuned.mismatch_mm - floor;
  text += "; most of the error is ";
  if (floor >= by_noise && floor >= by_mismatch) {
    return text +
           "also present without noise and model error, because the reference moves faster than this "
           "feedforward and feedback can follow";
  }
  return text + (by_mismatch >= by_noise ? "the model's mismatch" : "the sensor's noise");
}

}  // namespace

Tuned tune(const TuneTask& task) {
  Cost cost(task);
  Point best{};
  double least = std::numeric_limits<double>::max();
  for (const double kp : {0.02, 0.1, 0.4, 1.2, 3.0}) {
    for (const double ki : {0.1, 0.6, 2.0, 6.0, 14.0}) {
      const Point point{std::log(kp), std::log(ki), 0};
      const double value = cost(point);
      if (value < least) least = value, best = point;
    }
  }
  best = nelder_mead(std::ref(cost), best, least,
                     {.edges = {0.4, 0.4, 0.03}, .iterations = task.iterations, .done_share = 1e-3});
  Tuned tuned;
  tuned.pid = cost.gains(best);
  const LoopMargins margins = cost.margins(tuned.pid);
  tuned.sensitivity = margins.sensitivity;
  tuned.crossover_hz = margins.crossover_hz;
  tuned.rmse_mm = cost.rmse(tuned.pid, cost.fingers(), task.noise_mm);
  tuned.exact_mm = cost.rmse(tuned.pid, {task.finger}, 0);
  tuned.noisy_mm = cost.rmse(tuned.pid, {task.finger}, task.noise_mm);
  tuned.mismatch_mm = cost.rmse(tuned.pid, cost.fingers(), 0);
  tuned.evaluations = cost.evaluations;
  tuned.limited_by = limit_in_words(task, tuned);
  return tuned;
}

void choose_reference(TuneTask& task) {
  model::Chain<double> body(body_of(task.finger));
  const LimitSettings& limits = task.channel.limits;
  body.reset(resting_kpa(limits));
  const double rest_mm = body.after(model::Station::load);
  body.reset(far_end_kpa(limits));
  const double far_mm = limit_reference(limits, body.after(model::Station::load)).reference_mm;
  task.mean_mm = rest_mm + 0.45 * (far_mm - rest_mm);
  task.amplitude_mm = 0.22 * std::abs(far_mm - rest_mm);
}

}  // namespace softgrip::control
