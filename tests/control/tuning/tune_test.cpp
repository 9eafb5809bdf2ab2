#include "control/tuning/tune.h"

#include <gtest/gtest.h>

#include "tests/control/simulated_finger.h"

namespace softgrip::control::tune_test {
namespace {

TuneTask quick_task(FeedforwardKind kind) {
  TuneTask task;
  task.channel = sim::twin_settings();
  task.channel.limits.displacement_max_mm = 30;
  task.channel.feedforward.kind = kind;
  task.finger = sim::model_named("bench_twin");
  task.rate_hz = 100;
  task.frequencies_hz = {0.3};
  task.draws = 2;
  task.iterations = 12;
  return task;
}

TEST(Tune, KeepsTheSensitivityLimitAndBeatsLowGains) {
  const TuneTask task = quick_task(FeedforwardKind::none);
  const Tuned tuned = tune(task);
  EXPECT_LE(tuned.sensitivity, task.most_sensitivity);
  EXPECT_GT(tuned.sensitivity, 1);
  TrackingRun run;
  run.settings = task.channel;
  run.settings.pid = {0.3, 1, 0, 0.02, 1, AntiWindup::back_calculation, 0.5};
  run.finger = task.finger;
  run.rate_hz = task.rate_hz;
  run.frequency_hz = 0.3;
  EXPECT_LT(tuned.rmse_mm, track(run).rmse_mm);
  EXPECT_NE(tuned.limited_by.find("dead time"), std::string::npos) << tuned.limited_by;
}

TEST(Tune, ReportsTheMarginsOfTheModelWithoutMismatch) {
  TuneTask task = quick_task(FeedforwardKind::none);
  task.iterations = 4;
  task.mismatch = 0;  // no mismatch, so every simulated finger equals the model
  task.draws = 1;
  const Tuned tuned = tune(task);
  const double tick_s = 1 / task.rate_hz;
  const LoopMargins margins =
      loop_margins(task.finger, tuned.pid, task.channel.limits, tick_s, tick_s + task.exchange_s);
  EXPECT_EQ(tuned.sensitivity, margins.sensitivity);
  EXPECT_EQ(tuned.crossover_hz, margins.crossover_hz);
}

TEST(Tune, AnUnreachableLimitReducesTheSensitivity) {
  TuneTask task = quick_task(FeedforwardKind::none);
  task.most_sensitivity = 0.5;  // lower than the maximum sensitivity of any loop, so no gains meet this
                                // requirement
  const Tuned tuned = tune(task);
  task.most_sensitivity = 2;
  EXPECT_LT(tuned.sensitivity, tune(task).sensitivity);
}

TEST(Tune, ALowerSensitivityLimitIncreasesTheError) {
  TuneTask task = quick_task(FeedforwardKind::none);
  const Tuned bold = tune(task);
  task.most_sensitivity = 1.3;
  const Tuned careful = tune(task);
  EXPECT_LE(careful.sensitivity, 1.3);
  EXPECT_GT(careful.rmse_mm, bold.rmse_mm);
}

// The result text states which limit restricts the gains and which part of the error is largest. Both
// statements must agree with the numbers of the case.
TEST(Tune, ReportsTheLimitingEffectAndTheLargestError) {
  struct Case {
    const char* name;
    FeedforwardKind kind;
    double noise_mm, mismatch, most_sensitivity;
    const char* limit;
    const char* error;
  };
  for (const Case& test : {Case{"slow", FeedforwardKind::none, 0.01, 0.01, 1.5, "the stability margin",
                                "moves faster than this feedforward"},
                           Case{"noisy", FeedforwardKind::full_model, 1, 0.001, 50,
                                "effects other than the stability margin", "the sensor's noise"},
                           Case{"off", FeedforwardKind::full_model, 0.001, 0.15, 50,
                                "effects other than the stability margin", "the model's mismatch"}}) {
    SCOPED_TRACE(test.name);
    TuneTask task = quick_task(test.kind);
    task.noise_mm = test.noise_mm;
    task.mismatch = test.mismatch;
    task.most_sensitivity = test.most_sensitivity;
    task.iterations = 4;
    const Tuned tuned = tune(task);
    EXPECT_EQ(tuned.limited_by.find(test.limit), 0U) << tuned.limited_by << "; Ms " << tuned.sensitivity;
    EXPECT_NE(tuned.limited_by.find(test.error), std::string::npos)
        << tuned.limited_by << "; exact " << tuned.exact_mm << ", noisy " << tuned.noisy_mm << ", off "
        << tuned.mismatch_mm << " mm";
  }
}

TEST(Tune, NamesAValveLagOnlyIfTheModelHasALag) {
  TuneTask task = quick_task(FeedforwardKind::none);
  task.iterations = 12;
  task.most_sensitivity = 1.5;
  const Tuned with = tune(task);
  EXPECT_NE(with.limited_by.find("s of lag"), std::string::npos) << with.limited_by;
  task.finger = task.channel.model = model::without_block(task.finger, *model::find_block("valve_lag"));
  const Tuned without = tune(task);
  EXPECT_NE(without.limited_by.find("s of dead time"), std::string::npos) << without.limited_by;
  EXPECT_EQ(without.limited_by.find("s of lag"), std::string::npos) << without.limited_by;
}

// Below 0.1 Hz, the simulation settles for a quarter of a period instead of half a period, because a period
// is longer than 10 s.
TEST(Tune, SlowReferencesSettleForAQuarterOfACycle) {
  TuneTask task = quick_task(FeedforwardKind::none);
  task.iterations = 0;
  task.draws = 1;
  task.mismatch = 0;
  for (const auto& [frequency_hz, settling_cycles] : {std::pair(0.08, 0.25), std::pair(0.1, 0.5)}) {
    SCOPED_TRACE(frequency_hz);
    task.frequencies_hz = {frequency_hz};
    const Tuned tuned = tune(task);
    TrackingRun run;
    run.settings = task.channel;
    run.settings.pid = tuned.pid;
    run.finger = task.finger;
    run.rate_hz = task.rate_hz;
    run.exchange_s = task.exchange_s;
    run.mean_mm = task.mean_mm;
    run.amplitude_mm = task.amplitude_mm;
    run.frequency_hz = frequency_hz;
    run.noise_mm = 0;
    run.settling_cycles = settling_cycles;
    run.measured_cycles = 1;
    EXPECT_EQ(tuned.exact_mm, track(run).rmse_mm);
    run.settling_cycles = 0.75 - settling_cycles;
    EXPECT_NE(tuned.exact_mm, track(run).rmse_mm);
  }
}

TEST(Tune, EqualSeedsGiveEqualResults) {
  TuneTask task = quick_task(FeedforwardKind::full_model);
  task.iterations = 4;
  const Tuned first = tune(task);
  const Tuned second = tune(task);
  EXPECT_EQ(first.pid.kp_kpa_per_mm, second.pid.kp_kpa_per_mm);
  EXPECT_EQ(first.rmse_mm, second.rmse_mm);
}

TEST(Tune, TheReferenceIsWithinReach) {
  TuneTask task = quick_task(FeedforwardKind::none);
  choose_reference(task);
  EXPECT_GT(task.mean_mm - task.amplitude_mm, 1);
  EXPECT_LT(task.mean_mm + task.amplitude_mm, 30);
}

TEST(Tune, TheReferenceIsWithinReachBelowRest) {
  TuneTask task = quick_task(FeedforwardKind::none);
  LimitSettings& limits = task.channel.limits;
  limits.pressure_min_kpa = -80;
  limits.pressure_max_kpa = 10;
  limits.displacement_min_mm = -5;
  choose_reference(task);
  EXPECT_LT(task.mean_mm, 0);
  EXPECT_GT(task.mean_mm - task.amplitude_mm, limits.displacement_min_mm);
}

// The published model has no inverse. The test tunes the planned feedforward and the PID alone in the same
// way and compares their results.
TEST(Tune, PlannedTracksThePublishedModel3TimesBetterThanPid) {
  TuneTask task = quick_task(FeedforwardKind::none);
  task.finger = task.channel.model = sim::model_named("zhang2025");
  task.frequencies_hz = {0.2};
  const Tuned alone = tune(task);
  task.channel.feedforward.kind = FeedforwardKind::planned;
  const Tuned planned = tune(task);
  EXPECT_GT(alone.rmse_mm, 3 * planned.rmse_mm) << alone.rmse_mm << " and " << planned.rmse_mm << " mm";
}

}  // namespace
}  // namespace softgrip::control::tune_test
