#include "control/feedforward/free_motion.h"

#include <gtest/gtest.h>

#include "control/feedforward/free_curve.h"
#include "tests/control/settings_fixture.h"

namespace softgrip::control {
namespace {

TEST(FreeMotion, GoesWhereTheFreeCurveSays) {
  const LimitSettings limits = two_finger_settings().channels[0].limits;
  const FreeMotion motion = free_motion(twin(), limits);
  EXPECT_GT(motion.highest_mm, motion.lowest_mm + 5);
  EXPECT_NEAR(FreeCurve(twin(), limits).command_kpa(motion.highest_mm), limits.pressure_max_kpa, 1.5);
}

TEST(FreeMotion, IsNoFasterThanItsSlewLimits) {
  LimitSettings limits = two_finger_settings().channels[0].limits;
  limits.slew_up_kpa_per_s = limits.slew_down_kpa_per_s = 1000;
  const FreeMotion fast = free_motion(twin(), limits);
  limits.slew_up_kpa_per_s = limits.slew_down_kpa_per_s = 5;
  const FreeMotion slow = free_motion(twin(), limits);
  EXPECT_GT(fast.fastest_mm_per_s, 5 * slow.fastest_mm_per_s);
  EXPECT_GT(slow.fastest_mm_per_s, 5 * (slow.highest_mm - slow.lowest_mm) / limits.pressure_max_kpa);
  EXPECT_NEAR(fast.highest_mm, slow.highest_mm, 0.1 * slow.highest_mm);
}

}  // namespace
}  // namespace softgrip::control
