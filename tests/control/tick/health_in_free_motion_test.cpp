// Tests that the model health is evaluated in free motion only. Contact with a part must cause no alarm, but
// a finger that has changed must cause an alarm.

#include <gtest/gtest.h>

#include "tests/control/rig_fixture.h"

namespace softgrip::control::health_in_free_motion_test {
namespace {

class HealthInFreeMotionTest : public testing::Test {
 protected:
  HealthInFreeMotionTest() {
    for (ChannelSettings& channel : settings.channels) channel.health.unfit_mm = 1;
  }
  static bool unfit(const SimulatedRig& rig) {
    for (const Event& event : rig.events) {
      if (event.kind == Event::Kind::model_health_changed &&
          event.detail == Event::Detail(HealthState::unfit)) {
        return true;
      }
    }
    return false;
  }
  /// Returns bench_twin with the stiffness of all springs of the block kelvin_voigt multiplied by `times`.
  static model::Model stiffer(double times) {
    model::Model model = twin();
    auto values = model::flat_values(model);
    for (const char* const path :
         {"kelvin_voigt.k0_kpa_per_mm", "kelvin_voigt.k1_kpa_per_mm", "kelvin_voigt.k2_kpa_per_mm"}) {
      if (const auto place = model::find_path(model, path)) values[*place] *= times;
    }
    return model::with_values(model, values);
  }
  [[nodiscard]] PreparedSequence moves() const {
    return sequence_of(
        "name: x\nsteps:\n"
        "  - move: {pressure_kpa: 40, duration_s: 4, on_contact: ignore, settle_s: 6}\n"
        "  - move: {pressure_kpa: 5, duration_s: 4, on_contact: ignore, settle_s: 6}\n",
        settings);
  }
  RigSettings settings = two_finger_settings();
};

TEST_F(HealthInFreeMotionTest, APartHeldAfterAStopCausesNoHealthAlarm) {
  const PreparedSequence pick = example_sequence("pick_stone", settings);
  SimulatedRig rig(settings);
  rig.stone(8);
  ASSERT_TRUE(rig.start(pick));
  ASSERT_TRUE(rig.run_until_step(2, 20));
  rig.run(1);
  rig.request(Request::Kind::stop);
  ASSERT_TRUE(rig.run_until(State::idle, 5));
  ASSERT_GT(rig.output().channels[0].command_kpa, 5) << "the finger is still pressed on the part";
  rig.run(30);
  EXPECT_FALSE(unfit(rig));
}

TEST_F(HealthInFreeMotionTest, APartHeldAfterAFaultCausesNoHealthAlarm) {
  const PreparedSequence pick = example_sequence("pick_stone", settings);
  SimulatedRig rig(settings);
  rig.stone(8);
  ASSERT_TRUE(rig.start(pick));
  ASSERT_TRUE(rig.run_until_step(2, 20));
  rig.run(1);
  rig.fault[1].validity = model::Validity::sensor_error;
  ASSERT_TRUE(rig.run_until(State::faulted, 2));
  rig.fault[1].validity.reset();
  rig.run(0.5);
  rig.request(Request::Kind::acknowledge);
  ASSERT_TRUE(rig.run_until(State::idle, 1));
  ASSERT_GT(rig.output().channels[0].command_kpa, 5) << "the finger is still pressed on the part";
  ASSERT_NE(rig.result(0), GripResult::holding)
      << "the grip result does not report that the finger holds a part";
  rig.run(30);
  EXPECT_FALSE(unfit(rig));
}

TEST_F(HealthInFreeMotionTest, ContactDuringAMoveCausesNoHealthAlarm) {
  SimulatedRig rig(settings);
  rig.stone(6);
  const PreparedSequence sequence = moves();
  ASSERT_TRUE(rig.start(sequence));
  ASSERT_TRUE(rig.run_until(State::idle, 60));
  EXPECT_GT(rig.count(Event::Kind::contact), 0U);
  EXPECT_FALSE(unfit(rig));
}

TEST_F(HealthInFreeMotionTest, AStifferFingerCausesAHealthAlarm) {
  SimulatedRig rig(settings, 1, stiffer(1.3));
  const PreparedSequence sequence = moves();
  ASSERT_TRUE(rig.start(sequence));
  ASSERT_TRUE(rig.run_until(State::idle, 60));
  EXPECT_TRUE(unfit(rig));
}

TEST_F(HealthInFreeMotionTest, ASofterFingerCausesAHealthAlarm) {
  SimulatedRig rig(settings, 1, stiffer(0.75));
  const PreparedSequence sequence = moves();
  ASSERT_TRUE(rig.start(sequence));
  ASSERT_TRUE(rig.run_until(State::idle, 60));
  EXPECT_TRUE(unfit(rig));
}

}  // namespace
}  // namespace softgrip::control::health_in_free_motion_test
