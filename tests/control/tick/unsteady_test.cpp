// Tests a reading that jumps back and forth. The controller must report this reading as unsteady. If the rig
// file says so, the controller must also latch a fault. A sliding part must not be reported as an unsteady
// reading.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/control/rig_fixture.h"

namespace softgrip::control::unsteady_test {
namespace {

class UnsteadyTest : public testing::Test {
 protected:
  /// Disturbs the left reading for `seconds`: adds 5 mm in every second interval of 0.1 s.
  static void jump(SimulatedRig& rig, double seconds) {
    for (const double end_s = rig.time_s() + seconds; rig.time_s() < end_s;) {
      rig.fault[0].offset_mm = std::fmod(rig.time_s(), 0.2) < 0.1 ? 5 : 0;
      rig.tick();
    }
    rig.fault[0].offset_mm = 0;
  }
  RigSettings settings = two_finger_settings();
};

TEST_F(UnsteadyTest, IsReportedOnceAndClearedOnce) {
  SimulatedRig rig(settings);
  ASSERT_TRUE(rig.run_until(State::idle, 1));
  jump(rig, 3);
  EXPECT_EQ(rig.count(Event::Kind::reading_unsteady), 1U);
  EXPECT_EQ(rig.count(Event::Kind::reading_steady), 0U);
  EXPECT_TRUE(rig.output().channels[0].unsteady);
  EXPECT_FALSE(rig.output().channels[1].unsteady);
  EXPECT_EQ(rig.count(Event::Kind::fault_latched), 0U)
      << "with these settings, an unsteady reading is not a fault";
  rig.run(4);
  EXPECT_EQ(rig.count(Event::Kind::reading_steady), 1U);
}

TEST_F(UnsteadyTest, IsAFaultIfConfiguredAsAFault) {
  settings.faults.unsteady_is_fault = true;
  SimulatedRig rig(settings);
  const PreparedSequence track = example_sequence("track_sine", settings);
  ASSERT_TRUE(rig.start_until_step(track, 1));
  const double from_s = rig.time_s();
  jump(rig, 1.5);
  EXPECT_EQ(rig.output().state, State::faulted);
  EXPECT_EQ(rig.output().first_fault.code, FaultCode::reading_jumped);
  for (const Event& event : rig.events) {
    if (event.kind != Event::Kind::fault_latched) continue;
    EXPECT_EQ(event.channel, 0);
    EXPECT_NEAR(std::abs(event.value), 5, 1);
  }
  EXPECT_GT(rig.time_s(), from_s);
  rig.request(Request::Kind::acknowledge);
  rig.tick();
  EXPECT_EQ(rig.answer(Event::Kind::request_refused)->detail,
            Event::Detail(RequestRefusal{RefusalCode::cause_persists, FaultCode::reading_jumped}));
  rig.run(3);
  rig.request(Request::Kind::acknowledge);
  rig.tick();
  EXPECT_TRUE(rig.answer(Event::Kind::fault_acknowledged).has_value());
}

TEST_F(UnsteadyTest, SlippingPartsAreNotUnsteadyReadings) {
  settings.faults.unsteady_is_fault = true;
  SimulatedRig rig(settings);
  const PreparedSequence pick = example_sequence("pick_stone", settings);
  rig.stone(12);
  ASSERT_TRUE(rig.start_until_step(pick, 2));
  for (const double at_mm : {13.0, 14.0, 12.5, 13.5}) {
    rig.stone(at_mm);
    rig.run(0.4);
  }
  rig.stone(std::nullopt);
  rig.run(10);
  EXPECT_EQ(rig.count(Event::Kind::reading_unsteady), 0U);
  EXPECT_EQ(rig.count(Event::Kind::fault_latched), 0U);
}

TEST_F(UnsteadyTest, AnUnusedSensorIsNotReported) {
  settings.faults.unsteady_is_fault = true;
  settings.channels[0].displacement_used = false;
  settings.channels[0].pressure_measured = true;
  SimulatedRig rig(settings);
  ASSERT_TRUE(rig.run_until(State::idle, 1));
  jump(rig, 2);
  EXPECT_EQ(rig.output().state, State::idle);
  EXPECT_EQ(rig.count(Event::Kind::reading_unsteady), 0U);
}

}  // namespace
}  // namespace softgrip::control::unsteady_test
