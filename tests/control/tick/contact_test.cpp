// Tests a finger in contact with a part. The gripping pressure of the finger must never exceed the limit of
// the step.

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "control/feedforward/free_curve.h"
#include "tests/control/rig_fixture.h"

namespace softgrip::control::contact_test {
namespace {

/// Amount by which the gripping pressure may exceed a limit because of sensor noise and the lag of a filter
/// [kPa].
constexpr double tolerance_kpa = 0.4;

class ContactTest : public testing::Test {
 protected:
  /// Returns the gripping pressure of the left finger [kPa]: the pressure of the finger minus the pressure
  /// that causes the same displacement in free motion.
  [[nodiscard]] double squeeze_kpa(const SimulatedRig& rig) const {
    return rig.output().channels[0].pressure_kpa - curve.command_kpa(rig.plant_mm(0));
  }
  /// Runs the sequence to its end and returns the largest gripping pressure of the left finger.
  double play(SimulatedRig& rig, const PreparedSequence& sequence, double seconds = 60) {
    EXPECT_TRUE(rig.start(sequence));
    double most = 0;
    const double end_s = rig.time_s() + seconds;
    while (rig.time_s() < end_s && rig.output().state != State::idle) {
      rig.tick();
      most = std::max(most, squeeze_kpa(rig));
    }
    EXPECT_EQ(rig.output().state, State::idle);
    return most;
  }
  static std::size_t contacts(const SimulatedRig& rig, OnContact action) {
    return static_cast<std::size_t>(
        std::count_if(rig.events.begin(), rig.events.end(), [&](const Event& event) {
          return event.kind == Event::Kind::contact && event.detail == Event::Detail(action);
        }));
  }
  [[nodiscard]] PreparedSequence steps(const std::string& text) const {
    return sequence_of("name: x\nsteps:\n" + text, settings);
  }

  RigSettings settings = two_finger_settings();
  FreeCurve curve{twin(), settings.channels[0].limits};
};

TEST_F(ContactTest, AStoneAtAnyPositionIsHeldWithinThePressureLimit) {
  const PreparedSequence pick = example_sequence("pick_stone", settings);
  const double allowed_kpa = pick.steps[1].step.bounds.squeeze_max_kpa;
  for (double at_mm = 2; at_mm <= 15; at_mm += 1) {
    SCOPED_TRACE(at_mm);
    SimulatedRig rig(settings);
    rig.stone(at_mm);
    EXPECT_LT(play(rig, pick), allowed_kpa + tolerance_kpa);
    EXPECT_EQ(rig.result(0), GripResult::released);
    EXPECT_EQ(rig.result(1), GripResult::released);
    EXPECT_EQ(rig.count(Event::Kind::fault_latched), 0U);
  }
}

TEST_F(ContactTest, TheRequestedGrippingPressureIsApplied) {
  const PreparedSequence pick = example_sequence("pick_stone", settings);
  for (const double at_mm : {5.0, 12.0}) {
    SimulatedRig rig(settings);
    rig.stone(at_mm);
    ASSERT_TRUE(rig.start(pick));
    ASSERT_TRUE(rig.run_until_step(2, 20));
    rig.run(1);
    EXPECT_NEAR(squeeze_kpa(rig), pick.steps[1].step.squeeze.by_kpa, 1) << at_mm;
    EXPECT_NEAR(rig.output().channels[0].squeeze_kpa, pick.steps[1].step.squeeze.by_kpa, 1) << at_mm;
  }
}

TEST_F(ContactTest, AMoveStopsAtContactByDefault) {
  const PreparedSequence move = steps("  - move: {displacement_mm: 14, speed_mm_per_s: 10, settle_s: 2}\n");
  SimulatedRig rig(settings);
  rig.stone(6);
  play(rig, move);
  EXPECT_EQ(contacts(rig, OnContact::hold), 2U) << "each finger reports one contact";
  rig.run(3);
  EXPECT_LT(squeeze_kpa(rig), curve.squeeze_for_kpa(settings.detection.margin_mm) + 1.5)
      << "the controller removes the pressure above the contact pressure";
  EXPECT_GT(squeeze_kpa(rig), 0.5) << "the contact remains";
  EXPECT_EQ(rig.count(Event::Kind::fault_latched), 0U);
}

TEST_F(ContactTest, ContactDuringAMoveCanStartTheGrip) {
  const PreparedSequence pick = example_sequence("pick_stone", settings);
  SimulatedRig rig(settings);
  rig.stone(4);
  rig.stone_only_left = true;
  ASSERT_TRUE(rig.start(pick));
  ASSERT_TRUE(rig.run_until_step(1, 20));
  EXPECT_EQ(contacts(rig, OnContact::grip), 1U);
  EXPECT_LT(rig.plant_mm(1), 8) << "the finger without contact begins the grip at its present position";
  ASSERT_TRUE(rig.run_until(State::idle, 60));
}

TEST_F(ContactTest, OnContactFailEndsAMoveWithError) {
  const PreparedSequence move =
      steps("  - move: {displacement_mm: 14, speed_mm_per_s: 10, on_contact: fail, on_fail: vent}\n");
  SimulatedRig rig(settings);
  rig.stone(6);
  play(rig, move);
  EXPECT_EQ(rig.result(0), GripResult::error);
  EXPECT_EQ(rig.board_kpa(0), 0);
  EXPECT_EQ(contacts(rig, OnContact::fail), 2U);
}

TEST_F(ContactTest, AMoveWithAToleranceFailsAtContactBeforeTheTimeout) {
  const PreparedSequence move = steps(
      "  - move: {displacement_mm: 14, speed_mm_per_s: 10, tolerance_mm: 0.5, settle_s: 0.2, "
      "timeout_s: 30, on_fail: vent}\n");
  SimulatedRig rig(settings);
  rig.stone(6);
  ASSERT_TRUE(rig.start(move));
  EXPECT_TRUE(rig.run_until(State::idle, 5));
  EXPECT_EQ(rig.result(0), GripResult::error);
}

TEST_F(ContactTest, OnContactIgnoreKeepsTheStepPressureLimit) {
  const PreparedSequence move = steps(
      "  - move: {displacement_mm: 16, speed_mm_per_s: 8, on_contact: ignore, pressure_max_kpa: 25, "
      "settle_s: 3}\n");
  SimulatedRig rig(settings);
  rig.stone(6);
  ASSERT_TRUE(rig.start(move));
  double most = 0;
  while (rig.output().state != State::idle && rig.time_s() < 20) {
    rig.tick();
    most = std::max(most, rig.output().channels[0].command_kpa);
  }
  EXPECT_NEAR(most, 25, 1e-9);
  EXPECT_EQ(contacts(rig, OnContact::ignore), 2U);
  EXPECT_GE(rig.count(Event::Kind::limit_binds), 1U) << "the limit is active long enough to be reported";
}

// If a limit of the rig file or of a step is active for some time, an event must report this limit. The table
// has one row per limit.
TEST_F(ContactTest, EveryLastingLimitCausesAnEvent) {
  const auto told = [](const SimulatedRig& rig) {
    std::set<std::string> names;
    for (const Event& event : rig.events) {
      if (event.kind == Event::Kind::limit_binds)
        names.emplace(name_of(std::get<BindingLimit>(event.detail)));
    }
    return names;
  };
  using Names = std::set<std::string>;
  const std::string onto_a_stone =
      "  - move: {displacement_mm: 16, speed_mm_per_s: 8, on_contact: ignore, settle_s: 3";
  struct Case {
    std::string step;
    std::function<void(LimitSettings&)> limit;
    Names expected;
  };
  const std::vector<Case> cases{
      {onto_a_stone + ", pressure_max_kpa: 25}\n", [](LimitSettings&) {}, {"step_pressure"}},
      {onto_a_stone + ", squeeze_max_kpa: 6}\n", [](LimitSettings&) {}, {"step_squeeze"}},
      {onto_a_stone + "}\n", [](LimitSettings& limits) { limits.pressure_max_kpa = 42; }, {"rig_pressure"}},
      {"  - move: {pressure_kpa: 30, settle_s: 2}\n",
       [](LimitSettings& limits) { limits.slew_up_kpa_per_s = 10; },
       {"rig_slew_up"}},
      {"  - move: {pressure_kpa: 30, settle_s: 1}\n  - move: {pressure_kpa: 0, settle_s: 3}\n",
       [](LimitSettings& limits) { limits.slew_down_kpa_per_s = 12; },
       {"rig_slew_down"}}};
  for (const Case& one : cases) {
    SCOPED_TRACE(one.step);
    RigSettings bounded = settings;
    for (ChannelSettings& channel : bounded.channels) one.limit(channel.limits);
    const PreparedSequence sequence = sequence_of("name: bound\nsteps:\n" + one.step, bounded);
    SimulatedRig rig(bounded);
    rig.stone(6);
    play(rig, sequence);
    EXPECT_EQ(told(rig), one.expected);
  }
}

TEST_F(ContactTest, FreeMotionsReportNoContactAndNoLimit) {
  const PreparedSequence moves = steps(
      "  - move: {displacement_mm: 20, speed_mm_per_s: 60, settle_s: 1}\n"
      "  - move: {displacement_mm: 4, speed_mm_per_s: 60, settle_s: 1}\n"
      "  - move: {pressure_kpa: 50, settle_s: 2}\n"
      "  - move: {pressure_kpa: 0, settle_s: 2}\n");
  SimulatedRig rig(settings);
  play(rig, moves);
  EXPECT_EQ(rig.count(Event::Kind::contact), 0U);
  EXPECT_EQ(rig.count(Event::Kind::limit_binds), 0U);
}

// If the displacement reading freezes, it looks as if a part had stopped the finger. The test freezes the
// reading at different times of a sequence. The grip result must never be HOLDING.
TEST_F(ContactTest, AFrozenReadingIsNeverReportedAsHolding) {
  for (const char* name : {"pick_stone", "hand_over", "pick_screw", "empty_grip"}) {
    const PreparedSequence sequence = example_sequence(name, settings);
    for (double after_s = 0.2; after_s < 8; after_s += 0.6) {
      SCOPED_TRACE(testing::Message() << name << " " << after_s);
      SimulatedRig rig(settings);
      ASSERT_TRUE(rig.start(sequence));
      rig.run(after_s);
      if (rig.output().state != State::running) continue;
      rig.fault[0].frozen_mm = rig.output().channels[0].displacement_mm;
      const double end_s = rig.time_s() + 60;
      while (may_rise(rig.output().state) && rig.time_s() < end_s) {
        rig.tick();
        ASSERT_NE(rig.result(0), GripResult::holding);
      }
      EXPECT_FALSE(may_rise(rig.output().state));
      EXPECT_TRUE(rig.output().first_fault.code == FaultCode::reading_frozen ||
                  rig.result(0) == GripResult::error || rig.result(0) == GripResult::no_part);
    }
  }
}

TEST_F(ContactTest, AHeldPartRemainsHeldDuringAMove) {
  const PreparedSequence carry = steps(
      "  - grip: {displacement_mm: 17, speed_mm_per_s: 4, squeeze_kpa: 5, squeeze_speed_kpa_per_s: 5, "
      "settle_s: 0.5, verify: {by: detection, window_s: 0.3}, timeout_s: 12, on_fail: vent}\n"
      "  - move: {pressure_kpa: 35, speed_kpa_per_s: 5, settle_s: 1}\n");
  SimulatedRig rig(settings);
  rig.stone(12);
  play(rig, carry);
  EXPECT_EQ(rig.result(0), GripResult::holding);
  EXPECT_NEAR(rig.board_kpa(0), 35, 1e-6) << "this pressure is the target of the step";
}

TEST_F(ContactTest, AYieldingPartIsGrippedAtTheRequestedPressure) {
  const PreparedSequence pick = example_sequence("pick_stone", settings);
  SimulatedRig rig(settings, 3);
  rig.yields = 0.5;
  rig.stone(8);
  ASSERT_TRUE(rig.start(pick));
  ASSERT_TRUE(rig.run_until_step(2, 20));
  EXPECT_EQ(rig.result(0), GripResult::holding);
  EXPECT_GT(rig.plant_mm(0), 8.5);
  EXPECT_NEAR(squeeze_kpa(rig), pick.steps[1].step.squeeze.by_kpa, 1.5);
}

TEST_F(ContactTest, ALostPartIsNotFollowedBeyondTheTarget) {
  const PreparedSequence pick = example_sequence("pick_stone", settings);
  SimulatedRig rig(settings);
  rig.stone(9);
  ASSERT_TRUE(rig.start(pick));
  while (contacts(rig, OnContact::squeeze) < 2 && rig.time_s() < 20) rig.tick();
  rig.run(0.1);
  rig.stone(std::nullopt);
  double most_mm = 0;
  while (rig.output().state != State::idle && rig.time_s() < 60) {
    rig.tick();
    most_mm = std::max(most_mm, rig.plant_mm(0));
  }
  EXPECT_EQ(rig.result(0), GripResult::no_part);
  EXPECT_LT(most_mm, pick.steps[1].step.target.value + 1)
      << "the finger does not move beyond the target of the step";
}

TEST_F(ContactTest, GrippingPressureStaysBoundedDuringALongHold) {
  const PreparedSequence pick = steps(
      "  - grip: {displacement_mm: 17, speed_mm_per_s: 4, squeeze_kpa: 5, squeeze_speed_kpa_per_s: 5, "
      "settle_s: 0.5, verify: {by: detection, window_s: 0.3}, timeout_s: 12, on_fail: vent}\n"
      "  - hold: {hold_s: 60, reverify_every_s: 0.25, on_fail: vent}\n");
  SimulatedRig rig(settings);
  rig.stone(14);
  play(rig, pick, 90);
  EXPECT_EQ(rig.result(0), GripResult::holding);
  EXPECT_LT(rig.output().channels[0].command_kpa - rig.output().channels[0].free_kpa, 5.5);
}

TEST_F(ContactTest, AHoldLastsUntilTheReleaseRequest) {
  const PreparedSequence hand_over = example_sequence("hand_over", settings);
  SimulatedRig rig(settings);
  rig.stone(12);
  ASSERT_TRUE(rig.start(hand_over));
  ASSERT_TRUE(rig.run_until_step(1, 20));
  rig.run(100);
  EXPECT_EQ(rig.result(0), GripResult::holding);
  rig.request(Request::Kind::release);
  rig.tick();
  EXPECT_TRUE(rig.answer(Event::Kind::release_asked));
  ASSERT_TRUE(rig.run_until(State::idle, 10));
  EXPECT_EQ(rig.result(0), GripResult::released);
  const auto end = std::find_if(rig.events.begin(), rig.events.end(), [](const Event& event) {
    return event.kind == Event::Kind::sequence_finished;
  });
  ASSERT_NE(end, rig.events.end());
  EXPECT_EQ(end->detail, Event::Detail(SequenceEnd::done));
}

/// A grip that ends at its timeout while the gripping pressure still rises.
const std::string unfinished_squeeze =
    "  - grip: {pressure_kpa: 55, speed_kpa_per_s: 20, squeeze_kpa: 20, squeeze_speed_kpa_per_s: 2, "
    "settle_s: 0.2, timeout_s: 6, on_fail: continue, verify: {by: detection, window_s: 0.2}}\n";

TEST_F(ContactTest, AHoldKeepsThePressureOfAnUnfinishedSqueeze) {
  const PreparedSequence sequence =
      steps(unfinished_squeeze + "  - hold: {hold_s: 2, reverify_every_s: 0.2, on_fail: hold}\n");
  SimulatedRig rig(settings);
  rig.stone(12);
  ASSERT_TRUE(rig.start_until_step(sequence, 1));
  const double held_kpa = rig.output().channels[0].command_kpa;
  EXPECT_GT(held_kpa, 20);
  rig.run(1.5);
  EXPECT_NEAR(rig.output().channels[0].command_kpa, held_kpa, 0.5);
  EXPECT_NEAR(rig.output().channels[1].command_kpa, held_kpa, 2);
}

TEST_F(ContactTest, AHoldDoesNotContinueTheSqueezeOfAnEarlierSequence) {
  for (ChannelSettings& channel : settings.channels) {
    channel.limits.rest_kpa = 10;
    channel.limits.pressure_min_kpa = -40;
    channel.limits.displacement_min_mm = -30;
  }
  const PreparedSequence squeeze = steps(unfinished_squeeze);
  const PreparedSequence hold = steps(
      "  - grip: {channels: [left], pressure_kpa: 40, duration_s: 1, settle_s: 0.5, timeout_s: 20, on_fail: "
      "hold, verify: {by: position, window_s: 0.2, displacement_min_mm: 1, displacement_max_mm: 34}}\n"
      "  - hold: {channels: [left, right], hold_s: 1, reverify_every_s: 0.2, on_fail: hold}\n");
  SimulatedRig rig(settings);
  rig.stone(12);
  ASSERT_TRUE(rig.start(squeeze));
  rig.run(4);
  ASSERT_GT(rig.output().channels[1].squeeze_kpa, 1) << "the gripping pressure rises";
  rig.request(Request::Kind::stop);
  rig.run(0.1);
  rig.stone(std::nullopt);
  rig.run(1);
  rig.request(Request::Kind::vent);
  rig.run(3);
  EXPECT_NEAR(rig.output().channels[1].command_kpa, 10, 0.1);
  ASSERT_TRUE(rig.start_until_step(hold, 1));
  rig.run(0.5);
  EXPECT_NEAR(rig.output().channels[1].command_kpa, 10, 0.1)
      << "the vented finger stays at its rest pressure";
}

TEST_F(ContactTest, AHoldAfterAMoveThatMetAPartLastsAsLongAsRequested) {
  for (const std::string end : {"hold_s: 3", "until: release"}) {
    SCOPED_TRACE(end);
    const PreparedSequence sequence = steps(
        "  - grip: {pressure_kpa: 20, speed_kpa_per_s: 20, settle_s: 0.5, timeout_s: 20, on_fail: continue, "
        "verify: {by: detection, window_s: 0.2}}\n"
        "  - move: {pressure_kpa: 50, speed_kpa_per_s: 10, on_contact: hold}\n"
        "  - hold: {" +
        end +
        ", reverify_every_s: 0.2, on_fail: hold}\n"
        "  - release: {duration_s: 1, purge_s: 0.5, timeout_s: 10, on_fail: vent}\n");
    SimulatedRig rig(settings);
    rig.stone(12);
    ASSERT_TRUE(rig.start_until_step(sequence, 2));
    EXPECT_EQ(contacts(rig, OnContact::hold), 2U);
    const double held_kpa = rig.output().channels[0].command_kpa;
    rig.run(2.5);
    EXPECT_EQ(rig.output().channels[0].step, 2);
    EXPECT_NEAR(rig.output().channels[0].command_kpa, held_kpa, 1);
    if (end == "until: release") rig.request(Request::Kind::release);
    EXPECT_TRUE(rig.run_until_step(3, 2));
  }
}

TEST_F(ContactTest, ATrackFailsIfAPartStoppedThePreviousMove) {
  for (const std::string failing : {"", ", on_contact: fail, retries: 1, on_fail: vent"}) {
    SCOPED_TRACE(failing);
    const PreparedSequence sequence = steps(
        "  - move: {displacement_mm: 14, speed_mm_per_s: 5, settle_s: 1}\n"
        "  - track: {mean_mm: 16, amplitude_mm: 2, frequency_hz: 0.5, cycles: 2" +
        failing + "}\n");
    SimulatedRig rig(settings);
    rig.stone(8);
    ASSERT_TRUE(rig.start_until_step(sequence, 1));
    const double met_kpa = rig.output().channels[0].command_kpa;
    while (rig.output().state != State::idle && rig.time_s() < 60) {
      rig.tick();
      ASSERT_LT(rig.output().channels[0].command_kpa, met_kpa + 1) << "no attempt presses against the part";
    }
    EXPECT_EQ(rig.result(0), GripResult::error);
    rig.run(1);
    EXPECT_EQ(rig.board_kpa(0), 0);
  }
}

TEST_F(ContactTest, AFrozenFingerKeepsItsPressureInAHold) {
  const PreparedSequence sequence = steps(
      "  - pressure: {points: [{time_s: 0, pressure_kpa: 0}, {time_s: 2, pressure_kpa: 55}], on_contact: "
      "grip, "
      "squeeze_max_kpa: 30}\n"
      "  - grip: {channels: [left], pressure_kpa: 30, speed_kpa_per_s: 20, settle_s: 0.5, timeout_s: 20, "
      "on_fail: "
      "continue, verify: {by: detection, window_s: 0.2}}\n"
      "  - hold: {channels: [left, right], hold_s: 2, reverify_every_s: 0.2, on_fail: hold}\n");
  SimulatedRig rig(settings);
  rig.stone(8);
  rig.stone_only_left = true;
  ASSERT_TRUE(rig.start_until_step(sequence, 2));
  const double frozen_kpa = rig.output().channels[1].command_kpa;
  ASSERT_LT(frozen_kpa, 50) << "the contact of the left finger has stopped the right finger";
  rig.run(1.5);
  EXPECT_EQ(rig.output().channels[0].step, 2);
  EXPECT_NEAR(rig.output().channels[1].command_kpa, frozen_kpa, 0.5);
}

TEST_F(ContactTest, NoPressureRisesAfterAReleaseRequestInAnyStep) {
  const PreparedSequence pick = example_sequence("pick_stone", settings);
  const PreparedSequence grip = steps(
      "  - grip: {pressure_kpa: 40, speed_kpa_per_s: 20, settle_s: 0.5, verify: {by: detection, window_s: "
      "0.3}, timeout_s: 6, on_fail: vent}\n"
      "  - hold: {until: release, reverify_every_s: 0.25, on_fail: vent}\n");
  for (const PreparedSequence* sequence : {&pick, &grip}) {
    for (double after_s = 0.1; after_s < 14; after_s += 0.9) {
      SCOPED_TRACE(after_s);
      SimulatedRig rig(settings);
      rig.stone(12);
      ASSERT_TRUE(rig.start(*sequence));
      rig.run(after_s);
      if (rig.output().state != State::running) continue;
      rig.request(Request::Kind::release);
      double last_kpa = rig.tick().channels[0].command_kpa;
      for (int i = 0; i < 200; ++i) {
        const double kpa = rig.tick().channels[0].command_kpa;
        ASSERT_LE(kpa, last_kpa + 1e-9);
        last_kpa = kpa;
      }
      ASSERT_TRUE(rig.run_until(State::idle, 10));
      EXPECT_EQ(rig.board_kpa(0), 0);
      EXPECT_NE(rig.result(0), GripResult::holding);
    }
  }
}

TEST_F(ContactTest, AReleaseAfterASequenceVentsAndASecondIsRefused) {
  const PreparedSequence grip = steps(
      "  - grip: {pressure_kpa: 40, speed_kpa_per_s: 20, settle_s: 0.5, verify: {by: detection, window_s: "
      "0.3}, timeout_s: 6, on_fail: vent}\n");
  SimulatedRig rig(settings);
  rig.stone(12);
  play(rig, grip);
  ASSERT_EQ(rig.result(0), GripResult::holding);
  rig.request(Request::Kind::release);
  ASSERT_TRUE(rig.run_until(State::idle, 5));
  EXPECT_EQ(rig.result(0), GripResult::released);
  EXPECT_EQ(rig.board_kpa(0), 0);
  rig.request(Request::Kind::release);
  rig.tick();
  const auto refused = rig.answer(Event::Kind::request_refused);
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->detail, Event::Detail(RequestRefusal{RefusalCode::nothing_to_release}));
}

}  // namespace
}  // namespace softgrip::control::contact_test
