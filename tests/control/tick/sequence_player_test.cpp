// Tests three kinds of sequences: sequences in which a step fails, sequences in which a step ends at
// different times for the two fingers, and sequences with many short steps.

#include "control/tick/sequence_player.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/control/rig_fixture.h"

namespace softgrip::control::sequence_player_test {
namespace {

const std::string grip_left =
    "  - grip: {channels: [left], pressure_kpa: 45, speed_kpa_per_s: 60, settle_s: 0.4, "
    "verify: {by: detection, window_s: 0.2}, timeout_s: 4, on_fail: ";
const std::string move_on =
    "  - move: {channels: [right], pressure_kpa: 20, speed_kpa_per_s: 60, settle_s: 0.5}\n";
const std::string let_go = "  - release: {purge_s: 0.5, timeout_s: 4, on_fail: vent}\n";

class SequencePlayback : public testing::Test {
 protected:
  PreparedSequence steps(const std::string& text) {
    return sequence_of("name: x\nsteps:\n" + text, settings);
  }

  void play(SimulatedRig& rig, const PreparedSequence& sequence) {
    ASSERT_TRUE(rig.start(sequence));
    ASSERT_TRUE(rig.run_until(State::idle, 60));
    rig.run(0.1);
  }

  static SequenceEnd end_of(const SimulatedRig& rig) {
    for (const Event& event : rig.events) {
      if (event.kind == Event::Kind::sequence_finished) {
        return std::get<SequenceEnd>(event.detail);
      }
    }
    ADD_FAILURE() << "the sequence did not finish";
    return SequenceEnd::done;
  }

  RigSettings settings = two_finger_settings();
};

TEST_F(SequencePlayback, EachOnFailActionSetsPressureStepsAndResults) {
  struct Case {
    const char* on_fail;
    SafeAction closing;  ///< safe action that the rig file states for the phase closing
    double left_kpa;     ///< pressure of the left finger at the end of the sequence [kPa]
    bool goes_on;        ///< true: the sequence continues with the move step after the failed grip
    bool lets_go;        ///< true: the release step runs and vents the finger
  };
  for (const Case& test :
       {Case{"vent", SafeAction::hold, 0, false, false}, Case{"hold", SafeAction::vent, 45, false, false},
        Case{"abort", SafeAction::vent, 0, false, false}, Case{"abort", SafeAction::hold, 45, false, false},
        Case{"release", SafeAction::hold, 0, false, true},
        Case{"continue", SafeAction::vent, 0, true, true}}) {
    SCOPED_TRACE(std::string(test.on_fail) + " " + std::string(name_of(test.closing)));
    settings.safety.safe_action.fill(test.closing == SafeAction::vent ? SafeAction::hold : SafeAction::vent);
    settings.safety.safe_action[static_cast<std::size_t>(Phase::closing)] = test.closing;
    const PreparedSequence sequence = steps(grip_left + test.on_fail + "}\n" + move_on + let_go);
    SimulatedRig rig(settings);  // this rig has no part between the fingers, so the grip fails
    play(rig, sequence);
    EXPECT_EQ(rig.result(0), GripResult::no_part);
    EXPECT_NEAR(rig.board_kpa(0), test.left_kpa, 1e-9);
    EXPECT_EQ(end_of(rig), SequenceEnd::failed);
    std::vector<std::uint16_t> begun;
    for (const Event& event : rig.events) {
      if (event.kind == Event::Kind::step_started) {
        begun.push_back(std::get<std::uint16_t>(event.detail));
      }
    }
    std::vector<std::uint16_t> expected{0};
    if (test.goes_on) {
      expected.push_back(1);
    }
    if (test.lets_go) {
      expected.push_back(2);
    }
    EXPECT_EQ(begun, expected);
    EXPECT_EQ(rig.result(1), test.lets_go ? GripResult::released : GripResult::error)
        << "the right finger also gets a result, although it has no grip step";
  }
}

TEST_F(SequencePlayback, ReleaseWithoutAReleaseStepVents) {
  settings.safety.safe_action.fill(SafeAction::hold);
  const PreparedSequence sequence = steps(grip_left + "release}\n");
  SimulatedRig rig(settings);
  play(rig, sequence);
  EXPECT_EQ(rig.board_kpa(0), 0);
  EXPECT_EQ(rig.result(0), GripResult::no_part);
}

TEST_F(SequencePlayback, EachFingerOfAStepHasASeparateResult) {
  const std::string grip =
      "  - grip: {pressure_kpa: 45, speed_kpa_per_s: 60, settle_s: 0.4, verify: {by: detection, window_s: "
      "0.2}, "
      "timeout_s: 4, on_fail: release}\n";
  SimulatedRig rig(settings);
  rig.stone(12);
  rig.stone_only_left = true;
  const PreparedSequence sequence = steps(grip + let_go);
  ASSERT_TRUE(rig.start_until_step(sequence, 1, 10));
  EXPECT_EQ(rig.result(0), GripResult::holding);
  EXPECT_EQ(rig.result(1), GripResult::no_part);
  ASSERT_TRUE(rig.run_until(State::idle, 10));
  EXPECT_EQ(rig.result(0), GripResult::released);
  EXPECT_EQ(rig.result(1), GripResult::no_part);
  EXPECT_EQ(end_of(rig), SequenceEnd::failed);
}

TEST_F(SequencePlayback, AStepStartsWhenTheSlowestFingerHasArrived) {
  // The right finger starts from 20 kPa. Both fingers move at the same speed, so the right finger arrives
  // before the left one.
  const PreparedSequence sequence = steps(move_on +
                                          "  - move: {pressure_kpa: 40, speed_kpa_per_s: 20}\n"
                                          "  - move: {pressure_kpa: 41, duration_s: 0.1}\n");
  SimulatedRig rig(settings);
  ASSERT_TRUE(rig.start_until_step(sequence, 2));
  EXPECT_NEAR(rig.output().channels[0].command_kpa, 40, 0.2);
  EXPECT_NEAR(rig.output().channels[1].command_kpa, 40, 0.2);
}

TEST_F(SequencePlayback, EachOf100ShortStepsReachesTheTarget) {
  std::string text = "  - move: {displacement_mm: 5, duration_s: 1}\n";
  for (int i = 1; i < 100; ++i) {
    text += "  - move: {displacement_mm: " + std::to_string(5 + i % 2) + ", duration_s: 0.02}\n";
  }
  const PreparedSequence sequence = steps(text);
  SimulatedRig rig(settings);
  ASSERT_TRUE(rig.start(sequence));
  std::uint16_t step = 0;
  double reference_mm = 0;
  while (rig.tick().state == State::running) {
    if (rig.output().channels[0].step != step) {
      EXPECT_NEAR(reference_mm, 5 + step % 2, 0.2) << "step " << step;
      step = rig.output().channels[0].step;
    }
    reference_mm = rig.output().channels[0].reference_mm;
  }
  EXPECT_EQ(step, 99);
}

TEST_F(SequencePlayback, ATrackAfterShortMovesIsExecutedCompletely) {
  for (int moves = 3; moves <= 8; ++moves) {
    for (const std::string duration_s : {"0.02", "0.05", "0.08", "0.1", "0.15"}) {
      SCOPED_TRACE(std::to_string(moves) + " moves of " + duration_s + " s");
      std::string text = "  - move: {displacement_mm: 9, duration_s: 1, settle_s: 1}\n";
      for (int i = 1; i <= moves; ++i) {
        text += "  - move: {displacement_mm: " + std::to_string(8 + (moves - i) % 2) +
                ", duration_s: " + duration_s + "}\n";
      }
      text += "  - track: {mean_mm: 9, amplitude_mm: 1, frequency_hz: 0.5, cycles: 1}\n";
      SimulatedRig rig(settings);
      ASSERT_TRUE(rig.start_until_step(steps(text), static_cast<std::uint16_t>(moves + 1)));
      const double start_s = rig.time_s();
      ASSERT_TRUE(rig.run_until(State::idle, 10));
      EXPECT_GE(rig.time_s() - start_s, 2);
      EXPECT_EQ(end_of(rig), SequenceEnd::done);
    }
  }
}

TEST_F(SequencePlayback, TheReferenceIsContinuousBetweenSteps) {
  const PreparedSequence sequence = steps(
      "  - move: {displacement_mm: 8, speed_mm_per_s: 15}\n"
      "  - move: {displacement_mm: 14, speed_mm_per_s: 15}\n"
      "  - move: {displacement_mm: 6, duration_s: 1, settle_s: 0.5}\n"
      "  - track: {mean_mm: 13, amplitude_mm: 7, frequency_hz: 0.5, cycles: 2}\n"
      "  - move: {displacement_mm: 10, duration_s: 1}\n");
  SimulatedRig rig(settings);
  ASSERT_TRUE(rig.start(sequence));
  double before_mm = rig.output().channels[0].reference_mm;
  while (rig.tick().state == State::running) {
    const double now_mm = rig.output().channels[0].reference_mm;
    EXPECT_NEAR(now_mm, before_mm, 25 / settings.rate_hz) << "at " << rig.time_s();
    before_mm = now_mm;
  }
}

TEST_F(SequencePlayback, GripResultEventsContainTheEvidence) {
  const PreparedSequence sequence = steps(grip_left + "release}\n" + let_go);
  SimulatedRig rig(settings);
  rig.stone(12);
  play(rig, sequence);
  std::vector<Event> answers;
  for (const Event& event : rig.events) {
    if (event.kind == Event::Kind::grip_result && event.channel == 0) {
      answers.push_back(event);
    }
  }
  ASSERT_EQ(answers.size(), 2U);
  EXPECT_EQ(answers[0].detail, Event::Detail(GripAnswer{GripResult::holding, GripEvidence::displacement}));
  EXPECT_GT(answers[0].value, settings.detection.margin_mm);
  EXPECT_EQ(std::get<GripAnswer>(answers[1].detail).result, GripResult::released);
  EXPECT_LT(answers[1].value, settings.detection.margin_mm);
}

}  // namespace
}  // namespace softgrip::control::sequence_player_test
