#include "control/feedforward/feedforward_kinds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "control/feedforward/invertibility.h"
#include "model/blocks/asymmetric_valve_lag.h"
#include "model/blocks/leak.h"
#include "model/blocks/pressure_regulator.h"
#include "model/blocks/pressure_scale.h"
#include "model/blocks/valve_deadband.h"
#include "model/named.h"
#include "tests/control/simulated_finger.h"

namespace softgrip::control::feedforward_test {
namespace {

using sim::model_named;
using sim::tick_s;

constexpr LimitSettings limits{0, 60, 400, 400, 0, 25, 1};

model::Model with_value(const model::Model& model, const std::string& path, double value) {
  auto values = model::flat_values(model);
  values[model::find_path(model, path).value()] = value;
  return model::with_values(model, values);
}

/// Returns a reference that moves from rest to 6 mm and then follows the sine of the tracking studies.
Reference sine_reference(double frequency_hz) {
  Reference reference;
  reference.start(0, 0);
  (void)reference.hold_for(0.2);
  (void)reference.ramp_for(6, 2);
  (void)reference.hold_for(1);
  (void)reference.sine(13, 7, frequency_hz, 4);
  return reference;
}

struct Outcome {
  double worst_mm = 0;
  double worst_step_kpa = 0;
  int out_of_reach = 0;
};

/// Runs the feedforward without a PID on a finger that equals the model. The feedforward is therefore the
/// only cause of the error.
Outcome run_alone(const model::Model& model, const FeedforwardSettings& settings, const Reference& reference,
                  double finger_late_s = 0) {
  Feedforward feedforward(model, settings, limits, tick_s);
  RunningModel running(model, tick_s, settings.extra_latency_s, 0.1);
  const int sub_steps = 5;
  model::Model plant = model;
  if (finger_late_s > 0) {
    plant = with_value(plant, "transport_delay.delay_s", dead_time_s(model) + finger_late_s);
  }
  model::Chain<double> finger(plant, {}, tick_s / sub_steps);
  FeedforwardQuery query{&reference, 0, 0};
  feedforward.enter(running, query, 0);
  Outcome run;
  double last = 0;
  for (int k = 0; k * tick_s < reference.end_s(); ++k) {
    query.time_s = k * tick_s;
    const FeedforwardStep step = feedforward.step(query);
    run.worst_step_kpa = std::max(run.worst_step_kpa, std::abs(step.pressure_kpa - last));
    last = step.pressure_kpa;
    run.out_of_reach += step.out_of_reach ? 1 : 0;
    finger.step(0, step.pressure_kpa);
    for (int i = 1; i <= sub_steps; ++i) {
      finger.step(tick_s / sub_steps, step.pressure_kpa);
      const double t = query.time_s + i * tick_s / sub_steps;
      run.worst_mm = std::max(run.worst_mm, std::abs(finger.reading_mm() - reference.at(t).value));
    }
  }
  return run;
}

TEST(FullModelFeedforward, TracksAFingerThatEqualsTheModel) {
  for (const double frequency : {0.05, 0.1, 0.2}) {
    const Outcome run =
        run_alone(model_named("bench_twin"), {FeedforwardKind::full_model, 0}, sine_reference(frequency));
    EXPECT_LT(run.worst_mm, 2e-3) << frequency << " Hz";
    EXPECT_EQ(run.out_of_reach, 0) << frequency << " Hz";
    EXPECT_LT(run.worst_step_kpa, 400 * tick_s) << "the command changes no faster than the slew limit";
  }
}

TEST(FullModelFeedforward, PreviewIncludesDeadTimeAndExtraLatency) {
  const model::Model twin = model_named("bench_twin");
  const Feedforward plain(twin, {FeedforwardKind::full_model, 0}, limits, tick_s);
  EXPECT_NEAR(plain.preview_s(), 0.130 + tick_s, 1e-12);
  const Outcome late = run_alone(twin, {FeedforwardKind::full_model, 0}, sine_reference(0.2), 0.0075);
  const Outcome known = run_alone(twin, {FeedforwardKind::full_model, 0.0075}, sine_reference(0.2), 0.0075);
  EXPECT_GT(late.worst_mm, 0.05);
  EXPECT_LT(known.worst_mm, 2e-3);
}

TEST(FullModelFeedforward, CompensatesTheSampleHoldOfAModelWithoutLag) {
  const model::Model fast = model::without_block(model_named("bench_twin"), *model::find_block("valve_lag"));
  // The board holds each command for one tick. This hold causes an error of at most half the largest change
  // of the reference per tick.
  const Outcome run = run_alone(fast, {FeedforwardKind::full_model, 0}, sine_reference(0.1));
  EXPECT_LT(run.worst_mm, 0.02);
}

// Tests a first-order valve lag with different time constants for filling and venting.
TEST(FullModelFeedforward, TracksThroughLagsThatDifferByDirection) {
  model::Model model = model::without_block(model_named("bench_twin"), *model::find_block("valve_lag"));
  model =
      model::with_block(model, model::block_of<model::AsymmetricValveLag>(
                                   {{"filling_time_constant_s", 0.03}, {"venting_time_constant_s", 0.06}}));
  const Outcome run = run_alone(model, {FeedforwardKind::full_model, 0}, sine_reference(0.1));
  EXPECT_LT(run.worst_mm, 2e-3);
  EXPECT_EQ(run.out_of_reach, 0);
}

// Returns bench_twin with a dead band of the valve and an electro-pneumatic regulator in place of the valve
// lag.
model::Model regulated_twin() {
  model::Model model = model::without_block(model_named("bench_twin"), *model::find_block("valve_lag"));
  model = model::with_block(model, model::block_of<model::ValveDeadband>({{"band_kpa", 1.2}}));
  return model::with_block(model,
                           model::block_of<model::PressureRegulator>({{"filling_time_constant_s", 0.03},
                                                                      {"venting_time_constant_s", 0.05},
                                                                      {"overlap_kpa", 0.5},
                                                                      {"integral_time_s", 0.4},
                                                                      {"full_open_kpa", 12}}));
}

TEST(FullModelFeedforward, TracksThroughADeadBandAndARegulator) {
  const model::Model model = regulated_twin();
  ASSERT_TRUE(check_feedforward(model, {FeedforwardKind::full_model, 0}, limits, tick_s));
  const Outcome run = run_alone(model, {FeedforwardKind::full_model, 0}, sine_reference(0.1));
  EXPECT_LT(run.worst_mm, 0.01);
}

// Earlier commands have changed the valve openings, the integral of the regulator and the position in the
// dead band. The feedforward must start with these values.
TEST(FullModelFeedforward, StartsFromTheStatesOfRegulatorAndDeadBand) {
  const model::Model model = regulated_twin();
  RunningModel running(model, tick_s, 0, 0.1);
  model::Chain<double> finger(model, {}, tick_s);
  const double held_kpa = 20;
  for (double t = 0; t < 3; t += tick_s) {
    running.advance(held_kpa);
    finger.step(0, held_kpa);
    finger.step(tick_s, held_kpa);
  }
  Reference reference;
  reference.start(0, {finger.reading_mm()});
  (void)reference.hold_for(0.5);
  (void)reference.ramp_for(15, 3);
  FeedforwardQuery query{&reference, 0, 0};
  Feedforward feedforward(model, {FeedforwardKind::full_model, 0}, limits, tick_s);
  feedforward.enter(running, query, held_kpa);
  double worst_mm = 0;
  for (; query.time_s < 3; query.time_s += tick_s) {
    const double command_kpa = feedforward.step(query).pressure_kpa;
    finger.step(0, command_kpa);
    finger.step(tick_s, command_kpa);
    worst_mm = std::max(worst_mm, std::abs(finger.reading_mm() - reference.at(query.time_s + tick_s).value));
  }
  EXPECT_LT(worst_mm, 0.05);
}

// A leak or a wrong pressure scale makes the pressure in the finger lower than the command. The command must
// compensate for this difference.
TEST(FullModelFeedforward, TracksThroughALeakAndAPressureScale) {
  const model::Model twin = model_named("bench_twin");
  const Reference sine = sine_reference(0.1);
  for (const model::Model& model :
       {model::with_block(twin, model::block_of<model::Leak>({{"share", 0.1}})),
        model::with_block(twin, model::block_of<model::PressureScale>({{"scale", 0.92}}))}) {
    ASSERT_TRUE(check_feedforward(model, {FeedforwardKind::full_model, 0}, limits, tick_s));
    const Outcome run = run_alone(model, {FeedforwardKind::full_model, 0}, sine);
    EXPECT_LT(run.worst_mm, 3e-3);
    EXPECT_EQ(run.out_of_reach, 0);
  }
}

TEST(FullModelFeedforward, AReferenceBeyondTheRangeIsFollowedToTheLimit) {
  const model::Model twin = model_named("bench_twin");
  Reference reference;
  reference.start(0, 0);
  (void)reference.hold_for(0.2);
  (void)reference.ramp_for(limits.displacement_max_mm + 3, 4);
  Feedforward feedforward(twin, {FeedforwardKind::full_model, 0}, {0, 80, 400, 400, 0, 25, 1}, tick_s);
  model::Chain<double> finger(twin, {}, tick_s);
  FeedforwardQuery query{&reference, 0, 0};
  feedforward.enter(RunningModel(twin, tick_s, 0, 0.1), query, 0);
  for (; query.time_s < 8; query.time_s += tick_s) {
    const double command = feedforward.step(query).pressure_kpa;
    finger.step(0, command);
    finger.step(tick_s, command);
    ASSERT_LT(finger.reading_mm(), limits.displacement_max_mm + 0.1);
  }
  EXPECT_NEAR(finger.reading_mm(), limits.displacement_max_mm, 2e-3);
}

TEST(FullModelFeedforward, TracksBeyondAContactOfTheModel) {
  model::Model model =
      with_block(model_named("bench_twin"), model::default_block(*model::find_block("contact")));
  model = with_value(model, "contact.position_mm", 15);
  model = with_value(model, "contact.stiffening", 0.5);
  Reference reference;
  reference.start(0, 0);
  (void)reference.hold_for(0.2);
  (void)reference.ramp_for(16, 4);
  (void)reference.hold_for(1);
  const Outcome run = run_alone(model, {FeedforwardKind::full_model, 0}, reference);
  EXPECT_LT(run.worst_mm, 2e-3);
}

TEST(FullModelFeedforward, ReportsOutOfReachAndResumesWithoutWindUp) {
  const model::Model twin = model_named("bench_twin");
  Feedforward feedforward(twin, {FeedforwardKind::full_model, 0}, limits, tick_s);
  RunningModel running(twin, tick_s, 0, 0.1);
  Reference reference;
  reference.start(0, 0);
  (void)reference.ramp_for(18, 2);
  (void)reference.hold_for(10);
  (void)reference.ramp_for(0, 0.6);  // the reference falls to 0 mm faster than the creep decays at 0 kPa
  (void)reference.hold_for(5);
  (void)reference.ramp_for(10, 2);
  (void)reference.hold_for(2);
  model::Chain<double> finger(twin, {}, tick_s);
  FeedforwardQuery query{&reference, 0, 0};
  feedforward.enter(running, query, 0);
  int low = 0, high = 0;
  for (int k = 0; k * tick_s < reference.end_s(); ++k) {
    query.time_s = k * tick_s;
    const FeedforwardStep step = feedforward.step(query);
    ASSERT_GE(step.pressure_kpa, 0);
    ASSERT_LE(step.pressure_kpa, 60);
    const double then = query.time_s + feedforward.preview_s();
    low += step.out_of_reach && then > 12 && then < 18;
    high += step.out_of_reach && then > 18.5;
    finger.step(0, step.pressure_kpa);
    finger.step(tick_s, step.pressure_kpa);
    if (query.time_s > 19) {
      ASSERT_NEAR(finger.reading_mm(), reference.at(query.time_s + tick_s).value, 2e-3) << query.time_s;
    }
  }
  EXPECT_GT(low, 400);
  EXPECT_EQ(high, 0);
}

TEST(FullModelFeedforward, AValveSaturationIsReportedAsOutOfReach) {
  model::Model model =
      with_block(model_named("bench_twin"), model::default_block(*model::find_block("pressure_saturation")));
  model = with_value(model, "pressure_saturation.limit_kpa", 30);
  Reference reference;
  reference.start(0, 0);
  (void)reference.ramp_for(20, 3);
  (void)reference.hold_for(2);
  const Outcome run = run_alone(model, {FeedforwardKind::full_model, 0}, reference);
  EXPECT_GT(run.out_of_reach, 100);
}

TEST(BoucWenFeedforward, InvertsOnlyTheBoucWenBlock) {
  const model::Model twin = model_named("bench_twin");
  Feedforward feedforward(twin, {FeedforwardKind::bouc_wen, 0}, limits, tick_s);
  RunningModel running(twin, tick_s, 0, 0.1);
  Reference reference;
  reference.start(0, 0);
  (void)reference.ramp_for(5, 2);
  FeedforwardQuery query{&reference, 0, 0};
  feedforward.enter(running, query, 0);
  EXPECT_EQ(feedforward.preview_s(), 0);
  const auto alone = model::only(twin, [](const model::BlockInfo& info) { return info.id == "bouc_wen"; });
  model::Chain<double> element(alone);
  for (int k = 0; k < 600; ++k) {
    query.time_s = k * tick_s;
    const FeedforwardStep step = feedforward.step(query);
    ASSERT_FALSE(step.out_of_reach);
    element.step(tick_s, step.pressure_kpa);
    ASSERT_NEAR(element.reading_mm(), reference.at(query.time_s).value, 1e-9);
  }
}

}  // namespace
}  // namespace softgrip::control::feedforward_test
