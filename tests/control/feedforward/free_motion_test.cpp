#include "control/feedforward/free_motion.h"

#include <gtest/gtest.h>

#include "control/feedforward/free_curve.h"
#include "control/feedforward/running_model.h"
#include "model/chain.h"
#include "tests/control/settings_fixture.h"

namespace softgrip::control::free_motion_test {
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

TEST(FreeMotion, WithoutAValveThePressureIsTheCommandAtOnce) {
  LimitSettings limits = two_finger_settings().channels[0].limits;
  limits.pressure_min_kpa = 6;
  limits.slew_up_kpa_per_s = limits.slew_down_kpa_per_s = 1000;
  const model::Model body = body_of(twin());
  const FreeMotion bare = free_motion(body, limits);
  const FreeMotion valved = free_motion(twin(), limits);
  EXPECT_NEAR(bare.highest_mm, valved.highest_mm, 0.01 * valved.highest_mm)
      << "the lag of the valve does not change the displacement at rest";
  EXPECT_GT(bare.fastest_mm_per_s, 1.5 * valved.fastest_mm_per_s)
      << "the finger is faster without the lag of the valve";
  model::Chain<double> resting(body);
  resting.reset(limits.pressure_min_kpa);
  resting.step(0, limits.pressure_min_kpa);
  EXPECT_EQ(bare.lowest_mm, resting.reading_mm());
}

}  // namespace
}  // namespace softgrip::control::free_motion_test
