#include "control/tuning/tracking_run.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "base/random.h"
#include "base/time.h"
#include "control/feedforward/invertibility.h"
#include "control/feedforward/running_model.h"
#include "control/sequences/planner.h"
#include "control/tick/channel_controller.h"
#include "model/blocks/kelvin_voigt.h"
#include "model/chain.h"
#include "model/dual.h"
#include "model/named.h"

namespace softgrip::control {
namespace {

constexpr double rest_s = 0.5;
constexpr double approach_s = 3;
/// Lowest frequency at which the frequency response of a loop is computed, and the ratio of two successive
/// frequencies.
constexpr double lowest_hz = 1e-3;
constexpr double step_factor = 1.005;

Reference reference_of(const TrackingRun& run) {
  Reference reference;
  reference.start(0, 0);
  (void)reference.hold_for(rest_s);
  (void)reference.ramp_for(run.mean_mm - run.amplitude_mm, approach_s);
  (void)reference.hold_for(1);
  (void)reference.sine(run.mean_mm, run.amplitude_mm, run.frequency_hz,
                       run.settling_cycles + run.measured_cycles + 1);
  return reference;
}

double quantised(double value, double step) {
  return step > 0 ? step * std::round(value / step) : value;
}

/// A simulated finger with a simulated board and a simulated clock.
class Bench {
 public:
  explicit Bench(const TrackingRun& run)
      : run_(run),
        tick_s_(1 / run.rate_hz),
        exchange_s_(std::clamp(run.exchange_s, 0.0, 0.99 * tick_s_)),
        finger_(run.finger, {}, tick_s_, run.seed),
        seed_(derived_seed(run.seed, 1)) {}

  /// Simulates the tick from its start to its exchange with the board. In the exchange, the board gets
  /// `command_kpa` as its output. Returns the reading that the board sends in this exchange.
  double exchange(double command_kpa) {
    if (exchange_s_ > 0) finger_.step(exchange_s_, out_kpa_);
    out_kpa_ = quantised(command_kpa, run_.command_step_kpa);
    finger_.step(0, out_kpa_);
    return quantised(finger_.reading_mm() + run_.noise_mm * normal_at(seed_, readings_++),
                     run_.reading_step_mm);
  }
  /// Advances the simulation to the end of the tick. Returns two displacements of the finger: halfway between
  /// the exchange and the end of the tick, and at the end of the tick.
  std::array<double, 2> rest_of_tick() {
    std::array<double, 2> places{};
    for (double& place : places) {
      finger_.step(0.5 * (tick_s_ - exchange_s_), out_kpa_);
      place = finger_.after(model::Station::load);
    }
    return places;
  }
  [[nodiscard]] double exchange_s() const { return exchange_s_; }

 private:
  const TrackingRun& run_;
  double tick_s_;
  double exchange_s_;
  model::Chain<double> finger_;
  std::uint64_t seed_;
  std::uint64_t readings_ = 0;
  double out_kpa_ = 0;
};

/// Smallest and largest instantaneous slope of displacement over pressure, over the working range in two
/// cycles. Two cycles are needed, because the hysteresis in the second cycle may differ from that in the
/// first.
struct GainRange {
  double smallest = std::numeric_limits<double>::max();
  double largest = 0;
};

void look_at_gains(const model::Model& body, double end_kpa, GainRange& range) {
  model::Chain<double> chain(body);
  constexpr int steps = 100;
  for (const bool leaving : {true, false, true, false}) {
    for (int i = 0; i <= steps; ++i) {
      const double pressure = end_kpa * (leaving ? i : steps - i) / steps;
      chain.step(0, pressure);
      for (const double aside : {1e-7, -1e-7}) {
        const double gain = chain.peek(0.0, model::Dual<double>(pressure + aside, 1)).v;
        range.smallest = std::min(range.smallest, gain);
        range.largest = std::max(range.largest, gain);
      }
    }
  }
}

GainRange gain_range(const model::Model& body, const LimitSettings& limits) {
  GainRange range;
  look_at_gains(body, limits.pressure_max_kpa, range);
  if (limits.pressure_min_kpa < 0) look_at_gains(body, limits.pressure_min_kpa, range);
  return range;
}

/// Returns the compliance of the creep at the complex frequency `s` [mm/kPa]. The instantaneous part of the
/// compliance is not included.
std::complex<double> creep(const model::Model& body, std::complex<double> s) {
  std::complex<double> sum = 0;
  for (const model::BlockSpec& block : body.blocks) {
    if (!model::is<model::KelvinVoigt>(block)) continue;
    for (std::size_t i = 1; i + 1 < block.values.size(); i += 2) {
      sum += 1.0 / (block.values[i + 1] * s + block.values[i]);
    }
  }
  return sum;
}

}  // namespace

PressurePlan plan_for(const TrackingRun& run) {
  const Reference reference = reference_of(run);
  Planner planner(run.settings.model, run.settings.limits, 1 / run.rate_hz);
  return planner.plan(reference, 0, reference.end_s());
}

TrackingResult track(const TrackingRun& run) {
  const double tick_s = 1 / run.rate_hz;
  const Nanoseconds tick_ns = nanoseconds(tick_s);
  const Reference reference = reference_of(run);
  ChannelController controller(run.settings, tick_s);
  ChannelOutput step;
  controller.start(0, step);
  Bench bench(run);
  ChannelInput input;
  input.demand.mode = ChannelDemand::Mode::displacement;
  input.demand.reference = &reference;

  PressurePlan own_plan;
  if (run.settings.feedforward.kind == FeedforwardKind::planned) {
    if (run.plan == nullptr) own_plan = plan_for(run);
    input.demand.plan = run.plan != nullptr ? run.plan : &own_plan;
  }

  const double start_s = rest_s + approach_s + 1 + run.settling_cycles / run.frequency_hz;
  const double end_s = start_s + run.measured_cycles / run.frequency_hz;
  TrackingResult result;
  double squares = 0, residuals = 0, ticks = 0;
  for (std::int64_t k = 0; static_cast<double>(k) * tick_s < end_s; ++k) {
    input.now = k * tick_ns;
    input.demand.time_s = static_cast<double>(k) * tick_s;
    controller.tick(input, step);
    input.reading.displacement_mm = bench.exchange(step.command_kpa);
    input.reading.sampled_at = input.now + static_cast<Nanoseconds>(1e9 * bench.exchange_s());
    input.reading.sequence = static_cast<std::uint32_t>(k + 1);
    input.reading.validity = model::Validity::valid;
    const std::array<double, 2> places = bench.rest_of_tick();
    if (input.demand.time_s < start_s) continue;
    const double middle_s = 0.5 * (bench.exchange_s() + tick_s);
    for (const auto& [place, at_s] : {std::pair(places[0], middle_s), std::pair(places[1], tick_s)}) {
      const double error = place - reference.value_at(input.demand.time_s + at_s);
      squares += 0.5 * error * error;
      result.worst_mm = std::max(result.worst_mm, std::abs(error));
    }
    if (run.trace != nullptr) {
      run.trace->time_s.push_back(input.demand.time_s - start_s);
      run.trace->reference_mm.push_back(reference.value_at(input.demand.time_s + tick_s));
      run.trace->displacement_mm.push_back(places[1]);
    }
    result.pressure_mean_kpa += step.command_kpa;
    result.pressure_most_kpa = std::max(result.pressure_most_kpa, step.command_kpa);
    residuals += std::isfinite(step.residual_mm) ? step.residual_mm * step.residual_mm : 0;
    result.out_of_reach_share += step.out_of_reach ? 1 : 0;
    result.cut_share += step.saturated || step.slewing ? 1 : 0;
    result.health = std::max(result.health, step.health);
    ++ticks;
  }
  result.rmse_mm = std::sqrt(squares / ticks);
  result.residual_rms_mm = std::sqrt(residuals / ticks);
  result.pressure_mean_kpa /= ticks;
  result.out_of_reach_share /= ticks;
  result.cut_share /= ticks;
  return result;
}

model::Model with_scatter(const model::Model& model, double relative, std::uint64_t seed) {
  std::vector<double> values = model::flat_values(model);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double factor = 1 + relative * (2 * uniform_at(seed, i) - 1);
    if (!model::parameter_spec(model, i).whole) values[i] *= factor;
  }
  return model::with_values(model, values);
}

LoopMargins loop_margins(const model::Model& model, const PidSettings& pid, const LimitSettings& limits,
                         double tick_s, double age_s) {
  const model::Model body = body_of(model);
  const GainRange gains = gain_range(body, limits);
  double lag_s = 0;
  if (const auto lag = model::find_path(model, "valve_lag.time_constant_s")) {
    lag_s = model::flat_values(model)[*lag];
  }
  const double dead_s = dead_time_s(model) + 0.5 * tick_s + age_s;
  LoopMargins margins;
  for (const double gain : {gains.smallest, gains.largest}) {
    bool beyond = true;  // true while the loop gain |L| is above 1; with an integrator, |L| is above 1 at the
                         // lowest frequency
    double phase = 0;
    std::complex<double> before = 0;
    const auto steps = static_cast<int>(std::log(0.5 / tick_s / lowest_hz) / std::log(step_factor));
    for (int i = 0; i < steps; ++i) {
      const double hz = lowest_hz * std::pow(step_factor, i);
      const std::complex<double> s(0, 2 * std::numbers::pi * hz);
      const std::complex<double> controller = pid.kp_kpa_per_mm + pid.ki_kpa_per_mm_s / s +
                                              pid.kd_kpa_s_per_mm * s / (1.0 + pid.derivative_filter_s * s);
      const std::complex<double> loop =
          controller * (gain + creep(body, s)) / (1.0 + lag_s * s) * std::exp(-dead_s * s);
      phase += before == 0.0 ? std::arg(loop) : std::arg(loop / before);
      before = loop;
      margins.sensitivity = std::max(margins.sensitivity, 1 / std::abs(1.0 + loop));
      if (phase < -std::numbers::pi && std::abs(loop) >= 1) {
        margins.sensitivity = std::numeric_limits<double>::infinity();
      }
      if (beyond && std::abs(loop) < 1) {
        beyond = false;
        margins.crossover_hz = margins.crossover_hz > 0 ? std::min(margins.crossover_hz, hz) : hz;
      }
    }
  }
  return margins;
}

}  // namespace softgrip::control
