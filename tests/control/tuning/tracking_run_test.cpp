#include "control/tuning/tracking_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "model/blocks/asymmetric_bouc_wen.h"
#include "model/blocks/bouc_wen.h"
#include "model/blocks/characteristic.h"
#include "model/chain.h"
#include "model/named.h"
#include "tests/control/simulated_finger.h"

namespace softgrip::control::tracking_run_test {
namespace {

using sim::model_named;
using sim::tick_s;

/// PID gains that the study bench/tracking_study.cpp finds for all feedforwards, with the requirement of a
/// maximum sensitivity Ms of at most 2.
constexpr PidSettings found{2.7, 13, 0, 0.02, 1, AntiWindup::back_calculation, 0.5};

constexpr LimitSettings to_60_kpa{0, 60};

TrackingRun run_with(FeedforwardKind kind, std::uint64_t seed) {
  TrackingRun run;
  run.finger = model_named("bench_twin");
  run.settings = sim::twin_settings();
  run.settings.limits.displacement_max_mm = 30;
  run.settings.feedforward.kind = kind;
  run.settings.pid = found;
  run.settings.model = with_scatter(run.finger, 0.05, seed);
  run.seed = seed;
  return run;
}

TEST(TrackingRun, AnInaccurateFullModelTracks10TimesBetterThanPid) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const double alone = track(run_with(FeedforwardKind::none, seed)).rmse_mm;
    const double full = track(run_with(FeedforwardKind::full_model, seed)).rmse_mm;
    EXPECT_GT(alone, 10 * full) << "seed " << seed << ": " << alone << " and " << full << " mm";
  }
}

TEST(TrackingRun, TheBoucWenPartAloneIsNoBetterThanNoFeedforward) {
  const double alone = track(run_with(FeedforwardKind::none, 1)).rmse_mm;
  EXPECT_GT(track(run_with(FeedforwardKind::bouc_wen, 1)).rmse_mm, alone);
}

TEST(TrackingRun, KnownExchangeLatencyIsCompensated) {
  TrackingRun run = run_with(FeedforwardKind::full_model, 1);
  run.settings.model = run.finger;
  run.settings.pid = {};
  run.noise_mm = 0;
  run.exchange_s = 0.002;
  run.settings.feedforward.extra_latency_s = 0;
  const double unknown = track(run).rmse_mm;
  run.settings.feedforward.extra_latency_s = 0.002;
  EXPECT_LT(track(run).rmse_mm, 0.1 * unknown);
}

TEST(TrackingRun, TheTraceAgreesWithTheReportedErrors) {
  TrackingRun run = run_with(FeedforwardKind::full_model, 1);
  run.measured_cycles = 1;
  TrackingTrace trace;
  run.trace = &trace;
  const TrackingResult result = track(run);
  ASSERT_EQ(trace.time_s.size(), std::lround(1 / run.frequency_hz * run.rate_hz));
  ASSERT_EQ(trace.reference_mm.size(), trace.time_s.size());
  ASSERT_EQ(trace.displacement_mm.size(), trace.time_s.size());
  EXPECT_NEAR(trace.time_s.front(), 0, 1 / run.rate_hz);
  double worst = 0;
  double squares = 0;
  for (std::size_t i = 0; i < trace.time_s.size(); ++i) {
    const double error = trace.displacement_mm[i] - trace.reference_mm[i];
    worst = std::max(worst, std::abs(error));
    squares += error * error;
  }
  // The RMSE of the result also includes the errors in the middle of each tick, so it differs slightly from
  // the RMSE that this test computes.
  EXPECT_LE(worst, result.worst_mm);
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(trace.time_s.size())), result.rmse_mm,
              0.1 * result.rmse_mm);
}

TEST(TrackingRun, APlannedRunComputesAMissingPlan) {
  TrackingRun run = run_with(FeedforwardKind::planned, 1);
  run.settling_cycles = 0;
  run.measured_cycles = 1;
  const PressurePlan plan = plan_for(run);
  const double own = track(run).rmse_mm;
  run.plan = &plan;
  EXPECT_EQ(track(run).rmse_mm, own);
  run.settings.feedforward.kind = FeedforwardKind::none;
  run.plan = nullptr;
  EXPECT_GT(track(run).rmse_mm, own);
}

TEST(TrackingRun, EqualSeedsGiveEqualResults) {
  TrackingRun run = run_with(FeedforwardKind::full_model, 3);
  run.reading_step_mm = 100.0 / 65536;
  run.command_step_kpa = 100.0 / 4096;
  const TrackingResult first = track(run);
  EXPECT_EQ(first.rmse_mm, track(run).rmse_mm);
  run.seed = 4;
  EXPECT_NE(first.rmse_mm, track(run).rmse_mm);
}

// Multiplies the parameters of 40 models by random factors with the scatter `scatter`. Counts the models that
// the health check does not judge healthy. The count must agree with the rate that model_health.h states.
TEST(TrackingRun, ModelHealthTolerates5PercentScatterAndNot20Percent) {
  const auto not_healthy = [](double scatter) {
    int count = 0;
    for (std::uint64_t i = 0; i < 40; ++i) {
      TrackingRun run = run_with(FeedforwardKind::none, 1);
      run.settings.model = with_scatter(run.finger, scatter, derived_seed(7, i));
      run.settings.health = {};
      run.frequency_hz = i % 2 == 0 ? 0.05 : 0.1;
      run.settling_cycles = 0;
      run.measured_cycles = 5;
      run.seed = i + 1;
      count += track(run).health > HealthState::healthy ? 1 : 0;
    }
    return count;
  };
  EXPECT_EQ(not_healthy(0), 0);
  EXPECT_EQ(not_healthy(0.05), 0);
  EXPECT_EQ(not_healthy(0.10), 5);
  EXPECT_EQ(not_healthy(0.20), 23);
}

// A loop whose margins are known: a plant 1/(c s) with a dead time, and a proportional controller with the
// gain K. At the angular frequency K/c, the loop gain |L| is 1. The phase at this frequency is -90 degrees
// minus the phase lag of the dead time.
TEST(LoopMargins, AgreeWithTheAnalyticMarginsOfAnIntegrator) {
  model::Model model = model::without_block(model_named("bench_twin"), *model::find_block("bouc_wen"));
  model = model::without_block(model, *model::find_block("valve_lag"));
  auto values = model::flat_values(model);
  const auto set = [&](const char* path, double value) {
    values[model::find_path(model, path).value()] = value;
  };
  set("kelvin_voigt.k0_kpa_per_mm", 1e9);
  set("kelvin_voigt.k1_kpa_per_mm", 0);
  set("kelvin_voigt.c1_kpa_s_per_mm", 1);
  set("kelvin_voigt.k2_kpa_per_mm", 1e9);
  set("transport_delay.delay_s", 0.1);
  model = model::with_values(model, values);
  const double dead_s = 0.1 + 0.5 * tick_s + tick_s;
  const LoopMargins half =
      loop_margins(model, {5, 0, 0, 0.02, 1, AntiWindup::none, 1}, to_60_kpa, tick_s, tick_s);
  EXPECT_NEAR(half.crossover_hz, 5 / (2 * M_PI), 0.01);
  EXPECT_GT(half.sensitivity, 1.5);
  // With c = 1 and the dead time L, this loop is stable if K L < pi/2.
  const double limit = M_PI / 2 / dead_s;
  EXPECT_TRUE(std::isfinite(
      loop_margins(model, {0.98 * limit, 0, 0, 0.02, 1, AntiWindup::none, 1}, to_60_kpa, tick_s, tick_s)
          .sensitivity));
  EXPECT_FALSE(std::isfinite(
      loop_margins(model, {1.02 * limit, 0, 0, 0.02, 1, AntiWindup::none, 1}, to_60_kpa, tick_s, tick_s)
          .sensitivity));
}

/// Simulates two loading and unloading cycles of a finger. At each pressure, computes the slopes of the
/// displacement for rising and for falling pressure. Returns the smallest slope.
double smallest_gain(const model::Model& model, double pressure_max_kpa) {
  constexpr int steps = 1000;
  constexpr double aside_kpa = 1e-4;
  model::Chain<double> chain(model);
  double smallest = 1e9;
  for (int i = 0; i <= 4 * steps; ++i) {
    const int in_cycle = i % (2 * steps);
    const double pressure = pressure_max_kpa * std::min(in_cycle, 2 * steps - in_cycle) / steps;
    chain.step(0, pressure);
    const double here = chain.peek(0.0, pressure);
    for (const double aside : {aside_kpa, -aside_kpa}) {
      smallest = std::min(smallest, (chain.peek(0.0, pressure + aside) - here) / aside);
    }
  }
  return smallest;
}

/// Returns a finger that is stiffest at the end of its second unloading. At this point the finger is 2.7
/// times as stiff as at any earlier time.
model::Model stiff_at_its_end() {
  model::Model model = model::with_block({}, model::block_of<model::BoucWen>({{"alpha_mm_per_kpa", 0.39},
                                                                              {"beta_mm_per_kpa", 0.158},
                                                                              {"gamma_per_kpa", 0.002},
                                                                              {"eta_per_kpa", 0.017},
                                                                              {"exponent", 1}}));
  model = model::with_block(
      model, model::block_of<model::AsymmetricBoucWen>(
                 {{"beta_share", -0.35}, {"delta_per_kpa", -0.0004}, {"epsilon_per_kpa", 0.0129}}));
  model = model::with_block(model,
                            model::block_of<model::Characteristic>({{"curvature", 1.59}, {"span_mm", 20}}));
  return model;
}

// With integral control alone, the loop gain is |L| = ki gain / (2 pi f). The crossover frequency therefore
// shows which gain loop_margins() has used.
TEST(LoopMargins, UseTheSmallestGainOfTwoLoadCycles) {
  const model::Model model = stiff_at_its_end();
  const double gain = smallest_gain(model, 60);
  ASSERT_GT(gain, 0);
  const double ki = 1 / gain;
  const LoopMargins margins =
      loop_margins(model, {0, ki, 0, 0.02, 1, AntiWindup::none, 1}, to_60_kpa, tick_s, tick_s);
  EXPECT_NEAR(2 * M_PI * margins.crossover_hz / (ki * gain), 1, 0.01);
}

TEST(LoopMargins, DependOnThePressureRangeBelowZero) {
  const auto margins = [](const LimitSettings& limits) {
    return loop_margins(stiff_at_its_end(), {0, 1, 0, 0.02, 1, AntiWindup::none, 1}, limits, tick_s, tick_s);
  };
  const LoopMargins above = margins({0, 10});
  const LoopMargins below = margins({-60, 10});
  EXPECT_GT(std::abs(below.crossover_hz / above.crossover_hz - 1) +
                std::abs(below.sensitivity / above.sensitivity - 1),
            0.01);
}

TEST(LoopMargins, TheStudyGainsMeetTheSensitivityLimit) {
  const LoopMargins margins = loop_margins(model_named("bench_twin"), found, to_60_kpa, tick_s, tick_s);
  EXPECT_LT(margins.sensitivity, 2.05);
}

}  // namespace
}  // namespace softgrip::control::tracking_run_test
