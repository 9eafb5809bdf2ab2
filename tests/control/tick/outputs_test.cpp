// Tests two disturbances. In the first one, the outputs of the board differ from the commands. In the second
// one, the readings are out of date because of a gap in communication.

#include <gtest/gtest.h>

#include "tests/control/rig_fixture.h"

namespace softgrip::control::outputs_test {
namespace {

class Outputs : public testing::Test {
 protected:
  Outputs() { settings.safety.safe_action.fill(SafeAction::hold); }
  void close_on_stone(SimulatedRig& rig) { close_on_stone(rig, pick, 0.3); }
  static void close_on_stone(SimulatedRig& rig, const PreparedSequence& sequence, double into_grip_s) {
    rig.stone(12);
    ASSERT_TRUE(rig.start_until_step(sequence, 1, 10));
    rig.run(into_grip_s);
  }
  static double command(const SimulatedRig& rig) { return rig.output().channels[0].command_kpa; }

  RigSettings settings = two_finger_settings();
  PreparedSequence pick = example_sequence("pick_stone", settings);
};

TEST_F(Outputs, AStopContinuesFromTheOutputsOfTheBoard) {
  SimulatedRig rig(settings);
  close_on_stone(rig);
  const double last_kpa = command(rig);
  ASSERT_GT(last_kpa, 5);
  rig.outputs_kpa = {last_kpa - 0.5, 0.5};  // the output of the right channel is far below its command
  rig.request(Request::Kind::stop);
  rig.tick();
  EXPECT_DOUBLE_EQ(command(rig), last_kpa - 0.5);
  const double fall_kpa = settings.channels[1].limits.slew_down_kpa_per_s / settings.rate_hz;
  EXPECT_GE(rig.output().channels[1].command_kpa, last_kpa - 2 * fall_kpa)
      << "a command that was already sent may still be written";
  rig.run(1);
  EXPECT_DOUBLE_EQ(command(rig), last_kpa - 0.5);
  EXPECT_DOUBLE_EQ(rig.output().channels[1].command_kpa, 0.5);
}

TEST_F(Outputs, ARunningSequenceIgnoresOlderBoardOutputs) {
  SimulatedRig rig(settings);
  close_on_stone(rig);
  const double last_kpa = command(rig);
  rig.outputs_kpa = {last_kpa - 1, last_kpa - 1};  // the bus thread reports the outputs of the previous
                                                   // exchange
  rig.tick();
  EXPECT_GT(command(rig), last_kpa - 1);
}

TEST_F(Outputs, ABusFaultWithVentedOutputsKeepsTheCommandAtZero) {
  for (const FaultCode said : {FaultCode::board_watchdog_tripped, FaultCode::outputs_overwritten,
                               FaultCode::write_refused, FaultCode::cycles_lost}) {
    SimulatedRig rig(settings);
    close_on_stone(rig);
    rig.bus_fault = said;
    rig.outputs_kpa = {0, 0};
    rig.tick();
    EXPECT_EQ(rig.output().state, State::faulted);
    EXPECT_EQ(rig.output().first_fault.code, said);
    EXPECT_EQ(command(rig), 0);
    EXPECT_EQ(rig.output().channels[0].safe_kpa, 0)
        << "the bus must write 0 kPa if the control loop sends no commands";
    rig.bus_fault = FaultCode::none;
    rig.outputs_kpa.clear();
    rig.run(0.5);
    EXPECT_EQ(command(rig), 0);
  }
}

TEST_F(Outputs, OverwrittenOutputsAreVentedDespiteSafeActionHold) {
  SimulatedRig rig(settings);
  close_on_stone(rig);
  rig.bus_fault = FaultCode::outputs_overwritten;
  rig.tick();
  rig.run(0.5);
  EXPECT_EQ(command(rig), settings.channels[0].limits.pressure_min_kpa);
}

TEST_F(Outputs, HoldingIsNotReportedRightAfterAPause) {
  int tried = 0;
  for (double into_step_s = 0.2; into_step_s < 4; into_step_s += 0.1) {
    SimulatedRig rig(settings);
    close_on_stone(rig, pick, into_step_s);
    if (rig.result(0) != GripResult::none || rig.output().state != State::running) break;
    rig.pause(1);
    rig.tick();
    EXPECT_NE(rig.result(0), GripResult::holding) << "a pause " << into_step_s << " s into the grip";
    ++tried;
  }
  EXPECT_GE(tried, 10);
}

TEST_F(Outputs, AVentEndsWhenTheSlowestFingerIsVented) {
  for (const std::size_t slow : {0U, 1U}) {
    RigSettings one_is_slow = settings;
    one_is_slow.channels[slow].limits.slew_down_kpa_per_s /= 10;
    const PreparedSequence sequence = example_sequence("pick_stone", one_is_slow);
    SimulatedRig rig(one_is_slow);
    close_on_stone(rig, sequence, 0.3);
    rig.request(Request::Kind::vent);
    rig.tick();
    while (rig.output().state == State::stopping) rig.tick();
    EXPECT_EQ(rig.output().state, State::idle);
    EXPECT_EQ(rig.output().channels[slow].command_kpa, one_is_slow.channels[slow].limits.pressure_min_kpa);
  }
}

TEST_F(Outputs, InvalidAndValidReadingsAreReportedAsEvents) {
  SimulatedRig rig(settings);
  ASSERT_TRUE(rig.run_until(State::idle, 1));
  rig.events.clear();
  rig.fault[1].validity = model::Validity::sensor_error;
  rig.tick();
  ASSERT_EQ(rig.count(Event::Kind::reading_invalid), 1U);
  EXPECT_EQ(rig.count(Event::Kind::reading_valid), 0U);
  EXPECT_EQ(rig.events.back().channel, 1);
  EXPECT_EQ(rig.events.back().detail, Event::Detail(model::Validity::sensor_error));
  rig.fault[1].validity.reset();
  rig.tick();
  EXPECT_EQ(rig.count(Event::Kind::reading_valid), 1U);
}

TEST_F(Outputs, ARepeatedFaultIsReportedAfterTheAcknowledgement) {
  SimulatedRig rig(settings);
  ASSERT_TRUE(rig.run_until(State::idle, 1));
  for (int round = 0; round < 2; ++round) {
    rig.events.clear();
    rig.emergency_stop = true;
    rig.tick();
    rig.emergency_stop = false;
    rig.bus_fault = FaultCode::bus_down;  // inject a second fault while the first fault is latched
    rig.run(0.5);
    EXPECT_EQ(rig.count(Event::Kind::fault_latched), 2U) << "round " << round;
    rig.bus_fault = FaultCode::none;
    rig.run(0.5);
    rig.request(Request::Kind::acknowledge);
    ASSERT_TRUE(rig.run_until(State::idle, 2));
  }
}

TEST_F(Outputs, AStartOlderThanAVentOrStopIsRefused) {
  SimulatedRig rig(settings);
  ASSERT_TRUE(rig.run_until(State::idle, 1));
  for (const Request::Kind kind : {Request::Kind::vent, Request::Kind::stop}) {
    rig.request(Request{kind, 18, nullptr});
    rig.tick();
    ASSERT_TRUE(rig.run_until(State::idle, 5));
    rig.events.clear();
    rig.request(Request{Request::Kind::start, 17, &pick});
    rig.tick();
    EXPECT_EQ(rig.output().state, State::idle);
    ASSERT_EQ(rig.count(Event::Kind::request_refused), 1U);
    EXPECT_EQ(rig.events.front().detail, Event::Detail(RequestRefusal{RefusalCode::overtaken}));
    EXPECT_EQ(rig.events.front().request, 17U);
  }
  rig.request(Request{Request::Kind::start, 19, &pick});
  rig.tick();
  EXPECT_EQ(rig.output().state, State::resynchronising);
}

}  // namespace
}  // namespace softgrip::control::outputs_test
