// Tests complete grips in closed loop. Each grip must report the correct result.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/control/rig_fixture.h"

namespace softgrip::control::grip_cycle_test {
namespace {

class GripCycle : public testing::Test {
 protected:
  /// Waits until the start-up has ended, starts a sequence and runs the sequence to its end.
  void play(SimulatedRig& rig, const PreparedSequence& sequence, double seconds = 60) {
    ASSERT_TRUE(rig.start(sequence));
    ASSERT_TRUE(rig.run_until(State::idle, seconds));
  }

  RigSettings settings = two_finger_settings();
  PreparedSequence pick = example_sequence("pick_stone", settings);
};

TEST_F(GripCycle, AStoneIsHeldAndReleased) {
  SimulatedRig rig(settings);
  rig.stone(12);
  ASSERT_TRUE(rig.start_until_step(pick, 2));
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(rig.result(i), GripResult::holding);
    EXPECT_EQ(rig.output().channels[i].evidence, GripEvidence::displacement);
    EXPECT_GT(rig.output().channels[i].shortfall_mm, settings.detection.margin_mm);
  }
  ASSERT_TRUE(rig.run_until(State::idle, 30));
  EXPECT_EQ(rig.result(0), GripResult::released);
  EXPECT_EQ(rig.result(1), GripResult::released);
  EXPECT_EQ(rig.events.back().detail, Event::Detail(State::idle));
  EXPECT_EQ(rig.count(Event::Kind::fault_latched), 0U);
  EXPECT_NEAR(rig.board_kpa(0), 0, 1e-9);
}

TEST_F(GripCycle, AnEmptyGripReportsNoPart) {
  SimulatedRig rig(settings);
  play(rig, example_sequence("empty_grip", settings));
  EXPECT_EQ(rig.result(0), GripResult::no_part);
  EXPECT_EQ(rig.result(1), GripResult::no_part);
}

TEST_F(GripCycle, AMissingStoneReportsNoPartAfterOneRetry) {
  SimulatedRig rig(settings);
  play(rig, pick);
  EXPECT_EQ(rig.result(0), GripResult::no_part);
  std::size_t attempts = 0;
  for (const Event& event : rig.events) {
    attempts +=
        event.kind == Event::Kind::step_started && event.detail == Event::Detail(std::uint16_t{1}) ? 1U : 0U;
  }
  EXPECT_EQ(attempts, 2U);
}

TEST_F(GripCycle, AStoneInsertedBeforeTheRetryIsHeld) {
  SimulatedRig rig(settings);
  ASSERT_TRUE(rig.start_until_step(pick, 1));
  const std::size_t before = rig.count(Event::Kind::step_started);
  double waited = 0;
  while (rig.output().channels[0].displacement_mm < 16 && waited < 10) {
    rig.run(0.01);
    waited += 0.01;
  }
  while (rig.output().channels[0].displacement_mm > 10 && waited < 10) {
    rig.run(0.01);
    waited += 0.01;
  }
  rig.stone(12);
  ASSERT_TRUE(rig.run_until_step(2, 20));
  EXPECT_EQ(rig.count(Event::Kind::step_started), before + 2);
  EXPECT_EQ(rig.result(0), GripResult::holding);
}

TEST_F(GripCycle, AStonePulledOutDuringHoldIsPartLostWithinTwoReverifications) {
  SimulatedRig rig(settings);
  rig.stone(12);
  ASSERT_TRUE(rig.start_until_step(pick, 2));
  rig.run(1.13);
  ASSERT_EQ(rig.result(0), GripResult::holding);
  rig.stone(std::nullopt);
  rig.run(0.05);  // wait until the stone has been pulled out
  rig.run(2 * pick.steps[2].step.reverify_every_s);
  EXPECT_EQ(rig.result(0), GripResult::part_lost);
  ASSERT_TRUE(rig.run_until(State::idle, 20));
  EXPECT_EQ(rig.result(0), GripResult::part_lost)
      << "the grip result is latched, so the release does not overwrite the result";
  rig.run(1);
  EXPECT_EQ(rig.result(0), GripResult::part_lost);
  rig.request(Request::Kind::acknowledge);
  rig.tick();
  EXPECT_EQ(rig.result(0), GripResult::none);
  EXPECT_TRUE(rig.answer(Event::Kind::grip_result));
}

TEST_F(GripCycle, TheNextStartClearsPartLost) {
  SimulatedRig rig(settings);
  rig.stone(12);
  ASSERT_TRUE(rig.start_until_step(pick, 2));
  rig.stone(std::nullopt);
  ASSERT_TRUE(rig.run_until(State::idle, 20));
  ASSERT_EQ(rig.result(0), GripResult::part_lost);
  rig.stone(12);
  rig.request(Request::Kind::start, &pick);
  ASSERT_TRUE(rig.run_until(State::running, 12)) << "the finger comes to rest again";
  EXPECT_EQ(rig.result(0), GripResult::none);
  ASSERT_TRUE(rig.run_until(State::idle, 60));
  EXPECT_EQ(rig.result(0), GripResult::released);
}

TEST_F(GripCycle, APressureGripReportsHoldingAndReleased) {
  const PreparedSequence screw = example_sequence("pick_screw", settings);
  SimulatedRig rig(settings);
  rig.stone(12);
  ASSERT_TRUE(rig.start_until_step(screw, 2));
  EXPECT_EQ(rig.result(0), GripResult::holding);
  EXPECT_NEAR(rig.board_kpa(0), 45, 1e-6);
  ASSERT_TRUE(rig.run_until(State::idle, 20));
  EXPECT_EQ(rig.result(0), GripResult::released);
}

TEST_F(GripCycle, AHoldKeepsTheLastPressureOfAPressureStep) {
  const PreparedSequence sequence = sequence_of(
      "name: x\nsteps:\n"
      "  - grip: {pressure_kpa: 42, speed_kpa_per_s: 20, settle_s: 0.5, timeout_s: 20, on_fail: vent, "
      "verify: {by: "
      "detection, window_s: 0.2}}\n"
      "  - pressure: {points: [{time_s: 0, pressure_kpa: 42}, {time_s: 1, pressure_kpa: 48}]}\n"
      "  - hold: {hold_s: 3, reverify_every_s: 0.2, on_fail: hold}\n",
      settings);
  SimulatedRig rig(settings);
  rig.stone(12);
  ASSERT_TRUE(rig.start_until_step(sequence, 2));
  rig.run(2.5);
  EXPECT_EQ(rig.output().channels[0].step, 2);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(rig.output().channels[i].command_kpa, 48, 0.1);
    EXPECT_EQ(rig.result(i), GripResult::holding);
  }
}

TEST_F(GripCycle, AnObjectOutsideThePositionWindowIsNoPart) {
  const PreparedSequence screw = example_sequence("pick_screw", settings);
  SimulatedRig rig(settings);
  rig.stone(6.8);  // the fingers detect a part, but its position shows that it is too thick for a screw
  play(rig, screw);
  EXPECT_EQ(rig.result(0), GripResult::no_part);
}

TEST_F(GripCycle, AGripOfOneFingerLeavesTheOtherFingerVented) {
  settings.channels[1].limits.displacement_max_mm = 36;
  const PreparedSequence grip = sequence_of(R"(
name: x
steps:
  - grip: {channels: [left], pressure_kpa: 45, speed_kpa_per_s: 30, settle_s: 0.5, verify: {by: detection, window_s: 0.3}, timeout_s: 6, on_fail: vent}
)",
                                            settings);
  SimulatedRig rig(settings);
  rig.stone(12);
  play(rig, grip);
  EXPECT_EQ(rig.result(0), GripResult::holding);
  EXPECT_EQ(rig.result(1), GripResult::none);
  EXPECT_EQ(rig.board_kpa(1), 0);
}

TEST_F(GripCycle, AHeldPartIsMonitoredAfterTheSequence) {
  const PreparedSequence grip = sequence_of(R"(
name: pick_for_a_robot
steps:
  - grip: {pressure_kpa: 45, speed_kpa_per_s: 30, settle_s: 0.5, verify: {by: detection, window_s: 0.3}, timeout_s: 6, on_fail: vent}
)",
                                            settings);
  SimulatedRig rig(settings);
  rig.stone(12);
  play(rig, grip);
  rig.run(3);
  ASSERT_EQ(rig.result(0), GripResult::holding);
  EXPECT_NEAR(rig.board_kpa(0), 45, 1e-6);
  rig.stone(std::nullopt);
  rig.run(1);
  EXPECT_EQ(rig.result(0), GripResult::part_lost);
  EXPECT_EQ(rig.output().state, State::idle);
}

TEST_F(GripCycle, AReleaseSequenceStartsWithAHeldPart) {
  const PreparedSequence grip = sequence_of(R"(
name: pick
steps:
  - grip: {pressure_kpa: 45, speed_kpa_per_s: 30, settle_s: 0.5, verify: {by: detection, window_s: 0.3}, timeout_s: 6, on_fail: vent}
)",
                                            settings);
  const PreparedSequence place = sequence_of(
      "name: place\nsteps:\n  - release: {duration_s: 0.5, purge_s: 1, timeout_s: 5, on_fail: vent}\n",
      settings);
  SimulatedRig rig(settings);
  rig.stone(12);
  play(rig, grip);
  rig.run(2);
  rig.request(Request::Kind::start, &place);
  ASSERT_TRUE(rig.run_until(State::running, 12));
  ASSERT_TRUE(rig.run_until(State::idle, 10));
  EXPECT_EQ(rig.result(0), GripResult::released);
}

TEST_F(GripCycle, WithoutDisplacementFeedbackPressureVerifiesTheGrip) {
  for (ChannelSettings& channel : settings.channels) {
    channel.displacement_used = false;
  }
  const PreparedSequence grip = sequence_of(R"(
name: x
steps:
  - grip: {pressure_kpa: 45, speed_kpa_per_s: 30, settle_s: 0.5, verify: {by: pressure, window_s: 0.3, pressure_min_kpa: 40}, timeout_s: 6, on_fail: vent}
  - hold: {hold_s: 1, reverify_every_s: 0.2, on_fail: vent}
  - release: {purge_s: 1, timeout_s: 5, on_fail: vent}
)",
                                            settings);
  SimulatedRig rig(settings);
  rig.fault[0].validity = rig.fault[1].validity = model::Validity::out_of_range;  // the measuring beam of
                                                                                  // both sensors is blocked
  ASSERT_TRUE(rig.start_until_step(grip, 1));
  EXPECT_EQ(rig.result(0), GripResult::holding);
  EXPECT_EQ(rig.output().channels[0].evidence, GripEvidence::pressure);
  ASSERT_TRUE(rig.run_until(State::idle, 20));
  EXPECT_EQ(rig.result(0), GripResult::released);
  EXPECT_EQ(rig.output().channels[0].evidence, GripEvidence::none)
      << "no valid reading indicated that a part is held";
}

TEST_F(GripCycle, APartThatLeavesItsPositionWindowIsLost) {
  const PreparedSequence grip = sequence_of(R"(
name: x
steps:
  - grip: {pressure_kpa: 45, speed_kpa_per_s: 30, settle_s: 0.5, verify: {by: position, window_s: 0.3, displacement_min_mm: 10, displacement_max_mm: 14}, timeout_s: 6, on_fail: vent}
  - hold: {hold_s: 5, reverify_every_s: 0.2, on_fail: vent}
)",
                                            settings);
  for (const double moved_mm : {-4.0, 4.0}) {
    SCOPED_TRACE(moved_mm);
    SimulatedRig rig(settings);
    rig.stone(12);
    ASSERT_TRUE(rig.start_until_step(grip, 1));
    ASSERT_EQ(rig.result(0), GripResult::holding);
    rig.run(1);
    ASSERT_EQ(rig.result(0), GripResult::holding) << "within the window";
    rig.fault[0].offset_mm = moved_mm;
    rig.run(0.6);
    EXPECT_EQ(rig.result(0), GripResult::part_lost);
    EXPECT_EQ(rig.count(Event::Kind::fault_latched), 0U);
  }
}

TEST_F(GripCycle, AGripWithoutValidReadingsEndsWithError) {
  const PreparedSequence grip = sequence_of(R"(
name: x
steps:
  - grip: {pressure_kpa: 45, speed_kpa_per_s: 30, settle_s: 0.1, verify: {by: detection, window_s: 0.5}, timeout_s: 2.3, on_fail: vent}
)",
                                            settings);
  settings.faults.invalid_reading_cycles = 10'000;
  SimulatedRig rig(settings);
  rig.stone(12);
  ASSERT_TRUE(rig.start(grip));
  rig.run(1.55);  // the finger has arrived at its target
  rig.fault[0].validity = model::Validity::out_of_range;
  ASSERT_TRUE(rig.run_until(State::idle, 10));
  EXPECT_EQ(rig.result(0), GripResult::error)
      << "without a valid reading the result is neither HOLDING nor NO PART";
}

TEST_F(GripCycle, AFingerSettlesAtTheStartPressureBeforeARetry) {
  const PreparedSequence grip = sequence_of(R"(
name: x
steps:
  - grip: {pressure_kpa: 45, speed_kpa_per_s: 90, settle_s: 0.8, verify: {by: detection, window_s: 0.2}, timeout_s: 4, retries: 1, on_fail: vent}
)",
                                            settings);
  SimulatedRig rig(settings);
  ASSERT_TRUE(rig.run_until(State::idle, 1));
  rig.request(Request::Kind::start, &grip);
  std::vector<double> begun_s;
  double low_since_s = 0;  // last time at which the output exceeded its value at the start [s]
  for (std::size_t steps = 0; rig.time_s() < 30 && begun_s.size() < 2; rig.tick()) {
    if (rig.board_kpa(0) > 0.1) low_since_s = rig.time_s();
    if (const std::size_t now = rig.count(Event::Kind::step_started); now > steps) {
      steps = now;
      begun_s.push_back(rig.time_s());
    }
  }
  ASSERT_EQ(begun_s.size(), 2U);
  EXPECT_GT(begun_s[1] - low_since_s, 0.7)
      << "before the next attempt, the finger settles for settle_s at the start pressure";
}

TEST_F(GripCycle, AnUnreachableTargetEndsWithErrorAtTheTimeout) {
  const PreparedSequence move = sequence_of(R"(
name: x
steps:
  - move: {displacement_mm: 18, speed_mm_per_s: 20, tolerance_mm: 0.5, settle_s: 0.2, timeout_s: 4, on_fail: vent}
)",
                                            settings);
  SimulatedRig rig(settings);
  rig.stone(8);
  play(rig, move);
  EXPECT_EQ(rig.result(0), GripResult::error);
  EXPECT_EQ(rig.output().first_fault.code, FaultCode::none) << "a timeout is a result, not a fault";
  EXPECT_EQ(rig.board_kpa(0), 0);
}

TEST_F(GripCycle, AStickingPartEndsTheReleaseWithError) {
  const PreparedSequence grip = sequence_of(R"(
name: x
steps:
  - grip: {pressure_kpa: 45, speed_kpa_per_s: 30, settle_s: 0.5, verify: {by: detection, window_s: 0.3}, timeout_s: 6, on_fail: vent}
  - release: {pressure_kpa: 30, duration_s: 0.5, purge_s: 0.2, timeout_s: 3, on_fail: vent}
)",
                                            settings);
  SimulatedRig rig(settings);
  rig.stone(6);
  ASSERT_TRUE(rig.start_until_step(grip, 1));
  rig.fault[0].offset_mm = -3;  // a sensor offset of -3 mm looks like a displacement shortfall of 3 mm
  rig.run(0.1);
  ASSERT_TRUE(rig.run_until(State::idle, 10));
  EXPECT_EQ(rig.result(0), GripResult::error);
  EXPECT_EQ(rig.result(1), GripResult::released);
}

TEST_F(GripCycle, ABlockedFingerKeepsTheGrippingPressure) {
  SimulatedRig rig(settings);
  rig.stone(12);
  ASSERT_TRUE(rig.start_until_step(pick, 2));
  const double at_verification = rig.board_kpa(0);
  rig.run(4.5);
  EXPECT_LT(rig.board_kpa(0), at_verification + 1);
  EXPECT_FALSE(rig.output().channels[0].saturated);
}

TEST_F(GripCycle, FreeFingersTrackTheSineWithin100Micrometres) {
  const PreparedSequence track = example_sequence("track_sine", settings);
  SimulatedRig rig(settings);
  ASSERT_TRUE(rig.start_until_step(track, 1));
  double sum = 0;
  int count = 0;
  while (rig.output().state == State::running && rig.output().channels[0].step == 1) {
    rig.tick();
    const double error = rig.output().channels[0].reference_mm - rig.plant_mm(0);
    if (std::isfinite(error)) {
      sum += error * error;
      ++count;
    }
  }
  EXPECT_GT(count, 49 * settings.rate_hz);
  RecordProperty("tracking_rmse_um", static_cast<int>(1e3 * std::sqrt(sum / count)));
  EXPECT_LT(std::sqrt(sum / count), 0.1);
  ASSERT_TRUE(rig.run_until(State::idle, 20));
}

TEST_F(GripCycle, TheCommandEqualsThePressureProfile) {
  const PreparedSequence profile = sequence_of(R"(
name: x
steps:
  - pressure: {points: [{time_s: 0, pressure_kpa: 0}, {time_s: 1, pressure_kpa: 20}, {time_s: 2, pressure_kpa: 0}], cycles: 2}
)",
                                               settings);
  SimulatedRig rig(settings);
  ASSERT_TRUE(rig.start(profile));
  const double start = rig.time_s();
  for (double t = 0; t < 3.99; t = rig.time_s() - start) {
    EXPECT_NEAR(rig.output().channels[0].command_kpa, value_at(profile.steps[0].step.profile, t), 1e-6) << t;
    rig.tick();
  }
  ASSERT_TRUE(rig.run_until(State::idle, 1));
}

}  // namespace
}  // namespace softgrip::control::grip_cycle_test
