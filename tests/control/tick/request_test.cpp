// Sends every request in every state. Checks that the request has its effect or is refused. The controller
// must respond in the tick in which it receives the request.

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/control/rig_fixture.h"

namespace softgrip::control::request_test {
namespace {

class Requests : public testing::Test {
 protected:
  void expect_refused(SimulatedRig& rig, RefusalCode code) {
    rig.tick();
    const auto refused = rig.answer(Event::Kind::request_refused);
    ASSERT_TRUE(refused) << "expected " << name_of(code);
    EXPECT_EQ(refused->detail, Event::Detail(RequestRefusal{code})) << "expected " << name_of(code);
  }
  RigSettings settings = two_finger_settings();
  PreparedSequence pick = example_sequence("pick_stone", settings);
};

TEST_F(Requests, ACheckAnswersLikeAStartWithoutMotion) {
  SimulatedRig rig(settings);
  ASSERT_TRUE(rig.run_until(State::idle, 1));
  rig.request(Request::Kind::check, &pick);
  rig.tick();
  EXPECT_TRUE(rig.answer(Event::Kind::start_checked));
  EXPECT_EQ(rig.output().state, State::idle);
  rig.interlock_open = true;
  rig.request(Request::Kind::check, &pick);
  expect_refused(rig, RefusalCode::interlock_open);
  rig.interlock_open = false;
  ASSERT_TRUE(rig.start(pick));
  rig.request(Request::Kind::check, &pick);
  expect_refused(rig, RefusalCode::not_idle);
  EXPECT_EQ(rig.output().state, State::running);
}

TEST_F(Requests, StartIsRefusedWithItsReason) {
  SimulatedRig rig(settings);
  rig.wire_cut = true;
  rig.request(Request::Kind::start, &pick);
  expect_refused(rig, RefusalCode::no_valid_reading);
  rig.wire_cut = false;
  ASSERT_TRUE(rig.run_until(State::idle, 1));

  rig.request(Request::Kind::start, nullptr);
  expect_refused(rig, RefusalCode::sequence_unfit);
  RigSettings other = settings;
  other.channels[0].limits.pressure_max_kpa = 50;
  const PreparedSequence foreign = example_sequence("pick_stone", other);
  rig.request(Request::Kind::start, &foreign);
  expect_refused(rig, RefusalCode::sequence_unfit);

  rig.interlock_open = true;
  rig.request(Request::Kind::start, &pick);
  expect_refused(rig, RefusalCode::interlock_open);
  rig.interlock_open = false;

  rig.fault[1].validity = model::Validity::out_of_range;
  rig.tick();
  rig.request(Request::Kind::start, &pick);
  expect_refused(rig, RefusalCode::no_valid_reading);
  rig.fault[1].validity.reset();
  rig.tick();

  rig.request(Request::Kind::start, &pick);
  ASSERT_TRUE(rig.run_until(State::running, 5));
  rig.request(Request::Kind::start, &pick);
  expect_refused(rig, RefusalCode::not_idle);
  rig.request(Request::Kind::stop);
  rig.tick();
  rig.request(Request::Kind::start, &pick);
  rig.tick();
  EXPECT_TRUE(rig.answer(Event::Kind::request_refused) || rig.output().state == State::idle ||
              rig.output().state == State::resynchronising);
}

TEST_F(Requests, StopAndAcknowledgeAreRefusedWithoutATarget) {
  SimulatedRig rig(settings);
  ASSERT_TRUE(rig.run_until(State::idle, 1));
  rig.request(Request::Kind::stop);
  expect_refused(rig, RefusalCode::nothing_to_stop);
  rig.request(Request::Kind::acknowledge);
  expect_refused(rig, RefusalCode::nothing_to_acknowledge);
  rig.emergency_stop = true;
  rig.tick();
  rig.request(Request::Kind::stop);
  expect_refused(rig, RefusalCode::faulted);
}

TEST_F(Requests, StopAppliesTheSafeActionOfThePhase) {
  struct Case {
    int step;
    Phase phase;
    GripResult held;    ///< grip result after a stop whose safe action is hold
    GripResult vented;  ///< grip result after a stop whose safe action is vent
  };
  for (const Case& test : {Case{0, Phase::closing, GripResult::error, GripResult::error},
                           Case{1, Phase::closing, GripResult::error, GripResult::error},
                           Case{2, Phase::holding, GripResult::holding, GripResult::released},
                           Case{3, Phase::releasing, GripResult::error, GripResult::released}}) {
    for (const SafeAction action : {SafeAction::vent, SafeAction::hold}) {
      SCOPED_TRACE("step " + std::to_string(test.step) + " " + std::string(name_of(action)));
      settings.safety.safe_action.fill(action == SafeAction::vent ? SafeAction::hold : SafeAction::vent);
      settings.safety.safe_action[static_cast<std::size_t>(test.phase)] = action;
      SimulatedRig rig(settings);
      rig.stone(12);
      ASSERT_TRUE(rig.start(pick));
      ASSERT_TRUE(rig.run_until_step(static_cast<std::uint16_t>(test.step), 20));
      rig.run(0.1);
      rig.request(Request::Kind::stop);
      rig.tick();
      EXPECT_TRUE(rig.answer(Event::Kind::state_changed));
      const double at_stop_kpa = rig.output().channels[0].command_kpa;
      ASSERT_TRUE(rig.output().state == State::idle || rig.run_until(State::idle, 2));
      rig.run(0.05);
      EXPECT_NEAR(rig.board_kpa(0), action == SafeAction::vent ? 0 : at_stop_kpa, 1e-9);
      EXPECT_EQ(rig.result(0), action == SafeAction::vent ? test.vented : test.held);
      const auto finished = std::find_if(rig.events.begin(), rig.events.end(), [](const Event& event) {
        return event.kind == Event::Kind::sequence_finished;
      });
      ASSERT_NE(finished, rig.events.end());
      EXPECT_EQ(finished->detail, Event::Detail(SequenceEnd::stopped));
    }
  }
}

TEST_F(Requests, AStopDuringResynchronisationCancelsTheStart) {
  SimulatedRig rig(settings);
  ASSERT_TRUE(rig.run_until(State::idle, 1));
  rig.request(Request::Kind::start, &pick);
  ASSERT_TRUE(rig.run_until(State::resynchronising, 1));
  rig.request(Request::Kind::stop);
  ASSERT_TRUE(rig.run_until(State::idle, 1));
  rig.run(2);
  EXPECT_EQ(rig.output().state, State::idle);
  EXPECT_EQ(rig.count(Event::Kind::sequence_finished), 1U);
}

TEST_F(Requests, ANamedStopEndsOnlyTheNamedStart) {
  SimulatedRig rig(settings);
  ASSERT_TRUE(rig.run_until(State::idle, 1));
  rig.request({Request::Kind::start, 7, &pick});
  ASSERT_TRUE(rig.run_until(State::running, 5));
  rig.request({Request::Kind::stop, 8, nullptr, 6});
  rig.tick();
  EXPECT_EQ(rig.output().state, State::running)
      << "the stop request named a start other than the running one";
  const auto refused = std::ranges::find(rig.events, Event::Kind::request_refused, &Event::kind);
  ASSERT_NE(refused, rig.events.end());
  EXPECT_EQ(refused->request, 8U);
  EXPECT_EQ(refused->detail, Event::Detail(RequestRefusal{RefusalCode::named_start_not_running}));
  rig.request({Request::Kind::stop, 9, nullptr, 7});
  rig.tick();
  EXPECT_FALSE(may_rise(rig.output().state));
  EXPECT_EQ(rig.count(Event::Kind::sequence_finished), 1U);
  ASSERT_TRUE(rig.run_until(State::idle, 2));
  rig.request({Request::Kind::stop, 10, nullptr, 7});
  rig.tick();
  EXPECT_EQ(rig.count(Event::Kind::request_refused), 2U) << "the sequence has already ended";
}

TEST_F(Requests, ANamedStopRefusesAStartThatArrivesLater) {
  SimulatedRig rig(settings);
  ASSERT_TRUE(rig.run_until(State::idle, 1));
  const auto refused = [&](std::uint32_t id) {
    return std::ranges::any_of(rig.events, [id](const Event& event) {
      return event.kind == Event::Kind::request_refused && event.request == id;
    });
  };
  // A stop that refers to the start with id 7 arrives before this start. This is possible, because requests
  // can overtake each other. When the start arrives, the controller must refuse it.
  rig.request({Request::Kind::stop, 9, nullptr, 7});
  rig.tick();
  rig.request({Request::Kind::start, 7, &pick});
  rig.tick();
  EXPECT_EQ(rig.output().state, State::idle);
  EXPECT_TRUE(refused(7));
  rig.request({Request::Kind::start, 8, &pick});
  rig.tick();
  EXPECT_EQ(rig.output().state, State::resynchronising) << "no stop request named the running start";
  EXPECT_FALSE(refused(8));
}

TEST_F(Requests, StopsOfOldStartsDoNotDisplaceAPendingStop) {
  SimulatedRig rig(settings);
  ASSERT_TRUE(rig.run_until(State::idle, 1));
  rig.request({Request::Kind::check, 500, &pick});
  rig.tick();
  rig.request({Request::Kind::stop, 502, nullptr, 501});
  rig.tick();
  for (std::uint32_t id = 503; id < 703; ++id) {
    rig.request({Request::Kind::stop, id, nullptr, id - 300});
    rig.tick();
  }
  rig.request({Request::Kind::start, 501, &pick});
  rig.tick();
  EXPECT_EQ(rig.output().state, State::idle);
}

TEST_F(Requests, VentWorksAtStartWhileHoldingAndWhileFaulted) {
  SimulatedRig rig(settings);
  rig.request(Request::Kind::vent);
  rig.tick();
  EXPECT_TRUE(rig.answer(Event::Kind::state_changed));
  settings.safety.safe_action.fill(SafeAction::hold);
  settings.safety.on_emergency_stop = SafeAction::hold;
  for (const bool faulted : {false, true}) {
    SimulatedRig gripping(settings);
    gripping.stone(12);
    ASSERT_TRUE(gripping.start(pick));
    ASSERT_TRUE(gripping.run_until_step(2, 20));
    if (faulted) {
      gripping.emergency_stop = true;
      gripping.run(0.5);
      EXPECT_GT(gripping.board_kpa(0), 20);
    }
    gripping.request(Request::Kind::vent);
    gripping.tick();
    EXPECT_TRUE(gripping.answer(Event::Kind::state_changed));
    gripping.run(1);
    EXPECT_EQ(gripping.board_kpa(0), 0);
    EXPECT_EQ(gripping.output().state, faulted ? State::faulted : State::idle);
    EXPECT_EQ(gripping.result(0), faulted ? GripResult::error : GripResult::released);
  }
}

TEST_F(Requests, AnOpenInterlockStopsOnlySequencesWithAlways) {
  const PreparedSequence screw = example_sequence("pick_screw", settings);
  for (const bool always : {false, true}) {
    const PreparedSequence& sequence = always ? screw : pick;
    SimulatedRig rig(settings);
    rig.stone(12);
    ASSERT_TRUE(rig.start(sequence));
    ASSERT_TRUE(rig.run_until_step(1, 20));
    rig.interlock_open = true;
    rig.run(1);
    EXPECT_EQ(rig.output().state, always ? State::idle : State::running);
    EXPECT_EQ(rig.output().first_fault.code, FaultCode::none);
  }
}

TEST_F(Requests, AStartFailsIfAFingerDoesNotComeToRest) {
  SimulatedRig rig(settings);
  ASSERT_TRUE(rig.run_until(State::idle, 1));
  rig.request(Request::Kind::start, &pick);
  const double began = rig.time_s();
  for (bool up = false; rig.time_s() - began < settings.rest_timeout_s + 1; up = !up) {
    rig.fault[0].offset_mm = up ? 0.5 : -0.5;  // simulates a person who shakes the finger
    rig.run(0.1);
    ASSERT_NE(rig.output().state, State::running);
  }
  EXPECT_EQ(rig.output().state, State::idle);
  EXPECT_EQ(rig.result(0), GripResult::error);
  EXPECT_EQ(rig.count(Event::Kind::sequence_finished), 1U);
  const auto why = std::ranges::find(rig.events, Event::Kind::not_at_rest, &Event::kind);
  ASSERT_NE(why, rig.events.end());
  EXPECT_EQ(why->channel, 0);
  EXPECT_EQ(why->detail, Event::Detail(UnsettledReason::moves));
}

TEST_F(Requests, AStartWaitsUntilAnInflatedFingerIsAtRest) {
  const PreparedSequence press =
      sequence_of("name: x\nsteps:\n  - move: {pressure_kpa: 40, duration_s: 1}\n", settings);
  SimulatedRig rig(settings);
  ASSERT_TRUE(rig.start(press));
  ASSERT_TRUE(rig.run_until(State::idle, 5));
  rig.run(20);
  rig.request(Request::Kind::start, &press);
  const double began = rig.time_s();
  for (bool up = false; rig.time_s() - began < settings.rest_timeout_s - 1; up = !up) {
    rig.fault[0].offset_mm = up ? 0.5 : -0.5;
    rig.run(0.1);
    ASSERT_EQ(rig.output().state, State::resynchronising);
  }
  rig.fault[0].offset_mm = 0;
  EXPECT_TRUE(rig.run_until(State::running, 1)) << "the disturbance of the finger has ended";
}

TEST_F(Requests, AGripIsNotStartedIfTheFingerIsOffTheModel) {
  SimulatedRig rig(settings);
  rig.fault[0].offset_mm = 1.5 * settings.detection.margin_mm;
  ASSERT_TRUE(rig.run_until(State::idle, 1));
  rig.request(Request::Kind::start, &pick);
  rig.run(settings.rest_timeout_s + 1);
  EXPECT_EQ(rig.output().state, State::idle);
  EXPECT_EQ(rig.result(0), GripResult::error);
  const auto why = std::ranges::find(rig.events, Event::Kind::not_at_rest, &Event::kind);
  ASSERT_NE(why, rig.events.end());
  EXPECT_EQ(why->channel, 0);
  EXPECT_EQ(why->detail, Event::Detail(UnsettledReason::off_model));
  EXPECT_NEAR(why->value, 1.5 * settings.detection.margin_mm, 0.1);
  const PreparedSequence track = example_sequence("track_sine", settings);
  rig.request(Request::Kind::start, &track);
  EXPECT_TRUE(rig.run_until(State::running, 2))
      << "a sequence with only track steps starts even if the finger deviates from its model";
}

TEST_F(Requests, SafePressuresFollowThePhaseOfTheSequence) {
  settings.safety.safe_action = {SafeAction::vent, SafeAction::vent, SafeAction::hold, SafeAction::vent};
  SimulatedRig rig(settings);
  rig.stone(12);
  ASSERT_TRUE(rig.start(pick));
  for (std::uint16_t step = 0; step < 4; ++step) {
    ASSERT_TRUE(rig.run_until_step(step, 20));
    rig.run(0.1);
    const bool holds = step == 2;
    const ChannelOutput& left = rig.output().channels[0];
    EXPECT_EQ(left.safe_kpa, holds ? left.command_kpa : 0) << "step " << step;
  }
}

}  // namespace
}  // namespace softgrip::control::request_test
