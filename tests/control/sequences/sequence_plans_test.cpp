// Tests the planned feedforward from the sequence to the control loop. Checks the plans of a prepared
// sequence. Also checks the motion of the rig along these plans, with and without disturbances.

#include "control/sequences/sequence_plans.h"
#include "control/sequences/sequence_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "control/feedforward/feedforward_kinds.h"
#include "control/feedforward/running_model.h"
#include "tests/control/rig_fixture.h"
#include "tests/control/simulated_finger.h"

namespace softgrip::control::sequence_plans_test {
namespace {

/// PID gains that `softgrip tune --model config/models/zhang2025.yaml` prints with `--feedforward planned`
/// and with `--feedforward none`.
constexpr PidSettings for_planned{3.067, 12.68, 0, 0.01, 1, AntiWindup::back_calculation, 0.5};
constexpr PidSettings for_pid_alone{4.402, 13.79, 0, 0.01, 1, AntiWindup::back_calculation, 0.5};
/// PID gains for the finger bench_twin.
constexpr PidSettings twin_gains{2.7, 13, 0, 0.02, 1, AntiWindup::back_calculation, 0.5};

RigSettings rig_with(const char* model, FeedforwardKind kind, const PidSettings& pid) {
  RigSettings settings = two_finger_settings();
  for (ChannelSettings& channel : settings.channels) {
    channel.model = sim::model_named(model);
    channel.feedforward.kind = kind;
    channel.pid = pid;
  }
  EXPECT_EQ(settings_problems(settings), std::vector<std::string>{});
  return settings;
}

RigSettings planned_rig(const char* model) {
  return rig_with(model, FeedforwardKind::planned, model[0] == 'z' ? for_planned : twin_gains);
}

/// Returns the RMS difference [mm] between the reference and the true displacement of the finger during a
/// step.
double tracking_rmse_mm(const RigSettings& settings, const char* truth, const char* sequence,
                        std::uint16_t step) {
  const PreparedSequence prepared = example_sequence(sequence, settings);
  SimulatedRig rig(settings, 1, sim::model_named(truth));
  EXPECT_TRUE(rig.run_until(State::idle, 1));
  rig.request(Request::Kind::start, &prepared);
  EXPECT_TRUE(rig.run_until_step(step, 30));
  double squares = 0;
  double count = 0;
  while (rig.tick().state == State::running && rig.output().channels[0].step == step) {
    const double error = rig.plant_mm(0) - rig.output().channels[0].reference_mm;
    squares += error * error;
    ++count;
  }
  EXPECT_GT(count, 1000);
  return std::sqrt(squares / count);
}

TEST(SequencePlans, TracksThePublishedModelThreeTimesBetterThanPidAlone) {
  const double alone = tracking_rmse_mm(rig_with("zhang2025", FeedforwardKind::none, for_pid_alone),
                                        "zhang2025", "track_sine", 1);
  const double planned = tracking_rmse_mm(planned_rig("zhang2025"), "zhang2025", "track_sine", 1);
  std::printf("zhang2025: PID alone %.3f mm, planned %.3f mm\n", alone, planned);
  EXPECT_GT(alone, 3 * planned);
}

TEST(SequencePlans, TracksBenchTwinThreeTimesBetterThanPidAlone) {
  const double alone = tracking_rmse_mm(rig_with("bench_twin", FeedforwardKind::none, twin_gains),
                                        "bench_twin", "track_sine", 1);
  const double planned = tracking_rmse_mm(planned_rig("bench_twin"), "bench_twin", "track_sine", 1);
  std::printf("bench_twin: PID alone %.3f mm, planned %.3f mm\n", alone, planned);
  EXPECT_GT(alone, 3 * planned);
}

TEST(SequencePlans, EveryDisplacementMoveHasAPlanWithinTheLimits) {
  for (const char* model : {"zhang2025", "bench_twin"}) {
    SCOPED_TRACE(model);
    const RigSettings settings = planned_rig(model);
    const LimitSettings& limits = settings.channels[0].limits;
    const PreparedSequence pick = example_sequence("pick_stone", settings);
    ASSERT_EQ(pick.steps.size(), 4U);
    EXPECT_EQ(pick.steps[2].plan_of(0), nullptr) << "a hold step continues the plan of the grip step";
    EXPECT_EQ(pick.steps[3].plan_of(0), nullptr) << "a release step with a target pressure has no plan";
    for (const std::size_t k : {0U, 1U}) {
      const PressurePlan* plan = pick.steps[k].plan_of(0);
      ASSERT_NE(plan, nullptr);
      EXPECT_LT(plan->worst_mm, 0.1);
      for (std::size_t i = 1; i < plan->pressure_kpa.size(); ++i) {
        const double change = plan->pressure_kpa[i] - plan->pressure_kpa[i - 1];
        ASSERT_GE(plan->pressure_kpa[i], limits.pressure_min_kpa);
        ASSERT_LE(plan->pressure_kpa[i], limits.pressure_max_kpa);
        ASSERT_LE(change, limits.slew_up_kpa_per_s * plan->step_s + 1e-9);
        ASSERT_GE(change, -limits.slew_down_kpa_per_s * plan->step_s - 1e-9);
      }
    }
    const double grip_to_end_s = pick.steps[1].plan_of(0)->step_s *
                                 static_cast<double>(pick.steps[1].plan_of(0)->pressure_kpa.size() - 1);
    EXPECT_GT(grip_to_end_s, 5) << "the plan of the grip step lasts until the end of the hold step";
  }
}

TEST(SequencePlans, ArePreviewedByDeadTimeAndExtraLatency) {
  RigSettings settings = planned_rig("bench_twin");
  settings.channels[0].feedforward.extra_latency_s = 0.02;
  const PreparedSequence track = example_sequence("track_sine", settings);
  const double dead_s = dead_time_s(settings.channels[0].model);
  EXPECT_GT(dead_s, 0.1);
  const PressurePlan* left = track.steps[1].plan_of(0);
  EXPECT_NEAR(left->start_s - left->begin_s, dead_s + 0.02 + 0.5 / settings.rate_hz, 1e-9);
  const PressurePlan* right = track.steps[1].plan_of(1);
  EXPECT_NEAR(right->start_s - right->begin_s, dead_s + 0.5 / settings.rate_hz, 1e-9);
}

TEST(SequencePlans, APlanStartsFromThePreviousPressureStep) {
  const RigSettings settings = planned_rig("bench_twin");
  const PreparedSequence sequence = sequence_of(R"(
name: x
steps:
  - move: {pressure_kpa: 20, duration_s: 2, settle_s: 3}
  - move: {displacement_mm: 12, duration_s: 2}
)",
                                                settings);
  EXPECT_EQ(sequence.steps[0].plan_of(0), nullptr);
  const PressurePlan* plan = sequence.steps[1].plan_of(0);
  ASSERT_NE(plan, nullptr);
  EXPECT_NEAR(plan->pressure_kpa.front(), 20, 1e-6);
  EXPECT_GT(plan->displacement_mm.front(), 5);
  EXPECT_LT(plan->worst_mm, 0.05);
}

TEST(SequencePlans, ATooLongSequenceIsRefusedWithinOneSecond) {
  const RigSettings settings = planned_rig("zhang2025");
  document::Problems problems;
  const auto sequence = read_sequence(
      document::parse("long.yaml",
                      "name: x\nsteps:\n  - move: {displacement_mm: 6, duration_s: 1}\n"
                      "  - track: {mean_mm: 13, amplitude_mm: 7, frequency_hz: 0.1, cycles: 1000}\n",
                      problems),
      problems);
  ASSERT_TRUE(sequence) << problems.format();
  const std::clock_t begin = std::clock();
  EXPECT_FALSE(prepare(*sequence, settings, problems));
  EXPECT_LT(std::clock() - begin, CLOCKS_PER_SEC);
  EXPECT_NE(problems.format().find("more than 600 s of motion would have to be planned"), std::string::npos)
      << problems.format();
}

TEST(SequencePlans, AnUnreachableTargetCausesAWarningAtTheStep) {
  RigSettings settings = planned_rig("zhang2025");
  settings.channels[0].limits.slew_up_kpa_per_s = 5;
  document::Problems problems;
  const auto sequence = read_sequence(
      document::parse("fast.yaml", "name: x\nsteps:\n  - move: {displacement_mm: 15, duration_s: 2}\n",
                      problems),
      problems);
  ASSERT_TRUE(sequence && prepare(*sequence, settings, problems)) << problems.format();
  ASSERT_EQ(problems.warnings().size(), 1U);
  EXPECT_EQ(problems.warnings()[0].at.line, 3);
  EXPECT_NE(problems.warnings()[0].message.find("channel 'left' cannot follow"), std::string::npos);
}

TEST(SequencePlans, TheRigKeyChangesWithModelAndSlewLimit) {
  const RigSettings one = planned_rig("bench_twin");
  RigSettings other = planned_rig("zhang2025");
  EXPECT_NE(rig_key(one), rig_key(other));
  other = one;
  other.channels[1].limits.slew_up_kpa_per_s = 200;
  EXPECT_NE(rig_key(one), rig_key(other));
}

/// Largest upward and downward slope of a plan [kPa/s], and lowest and highest pressure of the plan [kPa].
struct PlanShape {
  double up_kpa_per_s = 0, down_kpa_per_s = 0, lowest_kpa = 1e9, highest_kpa = -1e9;
};
PlanShape shape_of(const PreparedSequence& sequence, std::size_t channel) {
  PlanShape shape;
  for (const PreparedStep& step : sequence.steps) {
    const PressurePlan& plan = *step.plan_of(channel);
    for (std::size_t i = 0; i < plan.pressure_kpa.size(); ++i) {
      shape.lowest_kpa = std::min(shape.lowest_kpa, plan.pressure_kpa[i]);
      shape.highest_kpa = std::max(shape.highest_kpa, plan.pressure_kpa[i]);
      if (i == 0) continue;
      const double speed = (plan.pressure_kpa[i] - plan.pressure_kpa[i - 1]) / plan.step_s;
      shape.up_kpa_per_s = std::max(shape.up_kpa_per_s, speed);
      shape.down_kpa_per_s = std::max(shape.down_kpa_per_s, -speed);
    }
  }
  return shape;
}

// Two fingers with equal settings share one plan. If any setting of the fingers differs, each finger has its
// own plan within its own limits.
TEST(SequencePlans, EachPlanKeepsTheLimitsOfTheFinger) {
  const std::string moves =
      "name: x\nsteps:\n  - move: {displacement_mm: 12, duration_s: 1}\n"
      "  - move: {displacement_mm: 1, duration_s: 1}\n";
  const RigSettings alike = planned_rig("bench_twin");
  const PreparedSequence shared = sequence_of(moves, alike);
  for (const PreparedStep& step : shared.steps) {
    EXPECT_EQ(step.plan_of(0)->pressure_kpa, step.plan_of(1)->pressure_kpa);
  }
  const PlanShape free = shape_of(shared, 1);
  const auto with = [&](const auto& change) {
    RigSettings other = alike;
    change(other.channels[1]);
    const PreparedSequence sequence = sequence_of(moves, other);
    EXPECT_EQ(sequence.steps[0].plan_of(0)->pressure_kpa, shared.steps[0].plan_of(0)->pressure_kpa);
    return shape_of(sequence, 1);
  };
  const double slow = 0.5 * std::min(free.up_kpa_per_s, free.down_kpa_per_s);
  EXPECT_LE(with([&](ChannelSettings& c) { c.limits.slew_up_kpa_per_s = slow; }).up_kpa_per_s, slow + 1e-6);
  EXPECT_LE(with([&](ChannelSettings& c) { c.limits.slew_down_kpa_per_s = slow; }).down_kpa_per_s,
            slow + 1e-6);
  const double low = 0.8 * free.highest_kpa;
  EXPECT_LE(with([&](ChannelSettings& c) { c.limits.pressure_max_kpa = low; }).highest_kpa, low + 1e-6);
  EXPECT_GE(with([](ChannelSettings& c) { c.limits.pressure_min_kpa = 1; }).lowest_kpa, 1 - 1e-6);
  RigSettings other_finger = alike;
  other_finger.channels[1].model = sim::model_named("zhang2025");
  const PreparedSequence own = sequence_of(moves, other_finger);
  EXPECT_EQ(own.steps[0].plan_of(0)->pressure_kpa, shared.steps[0].plan_of(0)->pressure_kpa);
  EXPECT_NE(own.steps[0].plan_of(1)->pressure_kpa, shared.steps[0].plan_of(1)->pressure_kpa);
  RigSettings late = alike;
  late.channels[1].feedforward.extra_latency_s = 0.01;
  const PreparedSequence read_earlier = sequence_of(moves, late);
  EXPECT_NEAR(read_earlier.steps[0].plan_of(1)->start_s - read_earlier.steps[0].plan_of(0)->start_s, 0.01,
              1e-9);
}

TEST(SequencePlans, AFingerOutsideAStepHasNoPlanForTheStep) {
  const PreparedSequence parted = sequence_of(
      "name: x\nsteps:\n  - move: {displacement_mm: 6, duration_s: 1}\n"
      "  - move: {channels: [left], displacement_mm: 8, duration_s: 1}\n",
      planned_rig("bench_twin"));
  EXPECT_NE(parted.steps[1].plan_of(0), nullptr);
  EXPECT_EQ(parted.steps[1].plan_of(1), nullptr);
}

TEST(SequencePlans, OnlyFingersWithPlannedFeedforwardHavePlans) {
  RigSettings mixed = planned_rig("bench_twin");
  mixed.channels[0].feedforward.kind = FeedforwardKind::full_model;
  const PreparedSequence move =
      sequence_of("name: x\nsteps:\n  - move: {displacement_mm: 6, duration_s: 1}\n", mixed);
  EXPECT_EQ(move.steps[0].plan_of(0), nullptr);
  EXPECT_NE(move.steps[0].plan_of(1), nullptr);
  EXPECT_EQ(move.steps[0].plan_of(7), nullptr) << "this channel does not exist";
}

// Grips a stone, then grips without a part, then grips the stone a second time. The grip without a part fails
// and is retried. Before the retry, the finger moves back without a plan.
TEST(SequencePlans, EveryGripReportsTheRightResult) {
  for (const char* model : {"zhang2025", "bench_twin"}) {
    SCOPED_TRACE(model);
    const RigSettings settings = planned_rig(model);
    const PreparedSequence pick = example_sequence("pick_stone", settings);
    SimulatedRig rig(settings, 1, sim::model_named(model));
    ASSERT_TRUE(rig.run_until(State::idle, 1));
    for (const bool stone : {true, false, true}) {
      if (stone) rig.stone(12);
      if (!stone) rig.stone(std::nullopt);
      rig.request(Request::Kind::start, &pick);
      ASSERT_TRUE(rig.run_until(State::running, 12));
      ASSERT_TRUE(rig.run_until(State::idle, 60));
      EXPECT_EQ(rig.result(0), stone ? GripResult::released : GripResult::no_part);
      EXPECT_EQ(rig.count(Event::Kind::fault_latched), 0U);
      if (!stone) rig.request(Request::Kind::acknowledge);
    }
  }
}

/// Results of a motion: the largest change of the command from one tick to the next, and the largest tracking
/// error.
struct Motion {
  double jump_kpa = 0;
  double worst_mm = 0;  ///< largest absolute difference between reference and displacement [mm]
};
Motion watch(SimulatedRig& rig, double seconds) {
  Motion motion;
  double before = rig.output().channels[0].command_kpa;
  for (double end = rig.time_s() + seconds; rig.time_s() < end && rig.tick().state == State::running;) {
    const ChannelOutput& channel = rig.output().channels[0];
    motion.jump_kpa = std::max(motion.jump_kpa, std::abs(channel.command_kpa - before));
    if (std::isfinite(channel.reference_mm)) {
      motion.worst_mm = std::max(motion.worst_mm, std::abs(channel.reference_mm - rig.plant_mm(0)));
    }
    before = channel.command_kpa;
  }
  return motion;
}

constexpr const char* slow_move = R"(
name: x
steps:
  - move: {displacement_mm: 15, duration_s: 3, settle_s: 3}
)";

// The sensor has a zero offset of 1.5 mm, but the plan assumes a sensor without offset. The feedforward must
// shift the planned motion by 1.5 mm.
TEST(SequencePlans, AFingerWithASensorOffsetReachesTheTarget) {
  for (const char* model : {"zhang2025", "bench_twin"}) {
    SCOPED_TRACE(model);
    const RigSettings settings = planned_rig(model);
    const PreparedSequence move = sequence_of(slow_move, settings);
    SimulatedRig rig(settings, 1, sim::model_named(model));
    rig.fault[0].offset_mm = 1.5;
    ASSERT_TRUE(rig.run_until(State::idle, 1));
    rig.request(Request::Kind::start, &move);
    ASSERT_TRUE(rig.run_until(State::running, 12));
    const Motion motion = watch(rig, 5);
    EXPECT_LT(motion.jump_kpa, 0.5)
        << "the planned motion and the sensor noise change the command by less than 0.5 kPa per tick";
    EXPECT_LT(motion.worst_mm, 1.5 + 0.8);
    EXPECT_NEAR(rig.plant_mm(0) + 1.5, 15, 0.15);
  }
}

/// Stops a sequence in the middle, while the finger is inflated, and then starts the next sequence.
Motion from_half_way(RigSettings settings, const char* truth) {
  settings.safety.safe_action.fill(SafeAction::hold);
  const PreparedSequence move = sequence_of(slow_move, settings);
  SimulatedRig rig(settings, 1, sim::model_named(truth));
  EXPECT_TRUE(rig.run_until(State::idle, 1));
  rig.request(Request::Kind::start, &move);
  EXPECT_TRUE(rig.run_until(State::running, 5));
  rig.run(2.4);
  rig.request(Request::Kind::stop);
  EXPECT_TRUE(rig.run_until(State::idle, 5));
  rig.run(4);
  EXPECT_GT(rig.board_kpa(0), 5);
  rig.request(Request::Kind::start, &move);
  EXPECT_TRUE(rig.run_until(State::running, 12));
  const Motion motion = watch(rig, 5);
  EXPECT_NEAR(rig.plant_mm(0), 15, 0.15);
  return motion;
}

TEST(SequencePlans, AStartFromAnotherDisplacementIsBumplessAndBetterThanPidAlone) {
  for (const char* model : {"zhang2025", "bench_twin"}) {
    SCOPED_TRACE(model);
    const Motion planned = from_half_way(planned_rig(model), model);
    const PidSettings& gains = model[0] == 'z' ? for_pid_alone : twin_gains;
    const Motion alone = from_half_way(rig_with(model, FeedforwardKind::none, gains), model);
    std::printf("%s: worst %.2f mm, with PID alone %.2f mm\n", model, planned.worst_mm, alone.worst_mm);
    EXPECT_LT(planned.jump_kpa, 0.5)
        << "the planned motion and the sensor noise change the command by less than 0.5 kPa per tick";
    EXPECT_LT(planned.worst_mm, alone.worst_mm);
  }
}

TEST(SequencePlans, TheMotionBeforeARetryIsBumpless) {
  for (const char* model : {"zhang2025", "bench_twin"}) {
    SCOPED_TRACE(model);
    const RigSettings settings = planned_rig(model);
    const PreparedSequence pick = example_sequence("pick_stone", settings);
    SimulatedRig rig(settings, 1, sim::model_named(model));
    ASSERT_TRUE(rig.run_until(State::idle, 1));
    rig.request(Request::Kind::start, &pick);
    ASSERT_TRUE(rig.run_until_step(1, 10));
    const Motion motion = watch(rig, 8);
    EXPECT_LT(motion.jump_kpa, 0.6)
        << "a speed of 10 mm/s requires about 0.2 kPa per tick; the remaining change is sensor noise";
    EXPECT_LT(motion.worst_mm, 2);
  }
}

// Without a plan, the command must change smoothly from the present pressure to the pressure of the settled
// line.
TEST(PlannedFeedforward, WithoutAPlanTheCommandFollowsTheSettledLine) {
  const model::Model twin = sim::model_named("bench_twin");
  const LimitSettings limits{0, 60, 400, 400, 0, 30, 1};
  Feedforward feedforward(twin, {FeedforwardKind::planned, 0}, limits, sim::tick_s);
  const RunningModel running(twin, sim::tick_s, 0, 0.1);
  Reference reference;
  reference.start(0, 5);
  (void)reference.hold_for(1);
  (void)reference.ramp_for(15, 2);
  FeedforwardQuery query{&reference, 0, 0, nullptr, 0};
  feedforward.enter(running, query, 30);
  EXPECT_NEAR(feedforward.step(query).pressure_kpa, 30, 1e-9)
      << "the first command equals the present pressure";
  double last = 30;
  for (int k = 1; k < 1000; ++k) {
    query.time_s = k * sim::tick_s;
    const double now = feedforward.step(query).pressure_kpa;
    ASSERT_LT(std::abs(now - last), 0.3);
    last = now;
  }
  EXPECT_NEAR(last, settled_line(twin, limits).pressure_kpa(15), 1e-9);
}

}  // namespace
}  // namespace softgrip::control::sequence_plans_test
