#include "tools/commissioning/motion_safety.h"

#include <gtest/gtest.h>

#include <cmath>

#include "rig/rig_file.h"
#include "tests/daemon/rig_under_test.h"

namespace softgrip::tools::motion_safety_test {
namespace {

class MotionSafetyTest : public ::testing::Test {
 protected:
  rig::RigFile rig_ = daemon::testing::example_rig("rig.yaml");
};

/// The limits are 0 to 60 kPa, and the tolerance is 5 kPa.
TEST_F(MotionSafetyTest, AManometerReadingThatPredictsAnOverpressureIsRefused) {
  const auto refused = [this](double command_kpa, double shown_kpa, double next_kpa) {
    return refusal_of(rig_, 0, {command_kpa, shown_kpa, next_kpa}).has_value();
  };
  EXPECT_FALSE(refused(10, 10, 40));
  EXPECT_FALSE(refused(10, 12.5, 40)) << "the pressure would be 50 kPa";
  EXPECT_TRUE(refused(10, 12.5, 60));
  EXPECT_TRUE(refused(10, 20, 40));
  EXPECT_TRUE(refused(40, 66, 10)) << "the reading is already above the limit";
  EXPECT_FALSE(refused(2, 3, 60)) << "the reading is uncertain by 1 kPa";
  EXPECT_FALSE(refused(0, 1, 60)) << "the first pressure is the rest pressure";
  EXPECT_NE(refusal_of(rig_, 0, {10, 20, 40})->find("would give about 76 kPa; the limits are 0 to 60 kPa"),
            std::string::npos)
      << *refusal_of(rig_, 0, {10, 20, 40});
  rig_ = daemon::testing::example_rig("vacuum/rig.yaml");
  EXPECT_FALSE(refused(-30, -30, -10));
  EXPECT_TRUE(refused(-10, -30, -30));
}

TEST_F(MotionSafetyTest, APressureMayExceedItsLimitsByTheTolerance) {
  EXPECT_FALSE(pressure_beyond(rig_, 0, 64.9));
  EXPECT_TRUE(pressure_beyond(rig_, 0, 65.1));
  EXPECT_TRUE(pressure_beyond(rig_, 0, -5.1));
  EXPECT_FALSE(pressure_beyond(rig_, 0, std::nan("")));
  rig_.settings.faults.pressure_tolerance_kpa = 0.1;
  EXPECT_FALSE(pressure_beyond(rig_, 0, 60.9)) << "the tolerance is at least 1 kPa";
  EXPECT_TRUE(pressure_beyond(rig_, 0, 61.1));
}

TEST_F(MotionSafetyTest, AFingerMayHoldAPartIfTheBoardDoesNotVent) {
  rig_.settings.safety.board_vents_when_silent = true;
  EXPECT_FALSE(may_hold_a_part(rig_));
  rig_.settings.safety.board_vents_when_silent = false;
  EXPECT_TRUE(may_hold_a_part(rig_));
  rig_.settings.safety.safe_action.fill(control::SafeAction::vent);
  EXPECT_FALSE(may_hold_a_part(rig_));
}

}  // namespace
}  // namespace softgrip::tools::motion_safety_test
