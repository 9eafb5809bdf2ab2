#include "control/feedforward/free_curve.h"

#include <gtest/gtest.h>

#include "control/feedforward/running_model.h"
#include "model/chain.h"
#include "tests/control/settings_fixture.h"
#include "tests/control/simulated_finger.h"

namespace softgrip::control::free_curve_test {
namespace {

using sim::model_named;
using sim::tick_s;

const LimitSettings limits = sim::twin_settings().limits;

/// Returns the displacement [mm] of a finger in free motion `seconds` after a jump of the command from 0 to
/// `command_kpa`.
double rests_at_mm(const model::Model& model, double command_kpa, double seconds) {
  model::Chain<double> chain(model, {}, tick_s);
  chain.step(0, command_kpa);
  for (double t = 0; t < seconds; t += tick_s) chain.step(tick_s, command_kpa);
  return chain.reading_mm();
}

TEST(FreeCurve, ReturnsTheCommandThatADisplacementNeeds) {
  for (const char* name : {"bench_twin", "zhang2025"}) {
    SCOPED_TRACE(name);
    const model::Model model = model_named(name);
    const FreeCurve curve(model, limits);
    for (double kpa = 1; kpa < 60; kpa += 3.7) {
      EXPECT_NEAR(curve.command_kpa(rests_at_mm(model, kpa, 3 + dead_time_s(model))), kpa, 0.05) << kpa;
    }
  }
}

TEST(FreeCurve, ExtrapolatesBeyondBothEnds) {
  const FreeCurve curve(model_named("bench_twin"), limits);
  EXPECT_NEAR(curve.command_kpa(0), 0, 0.05);
  EXPECT_LT(curve.command_kpa(-1), -1);
  EXPECT_GT(curve.command_kpa(40), curve.command_kpa(35) + 1);
}

TEST(FreeCurve, TheGrippingPressureForAShortfallSufficesEverywhere) {
  const FreeCurve curve(model_named("bench_twin"), limits);
  const double needed_kpa = curve.squeeze_for_kpa(1);
  for (double y_mm = 0; y_mm < 30; y_mm += 0.5) {
    EXPECT_LE(curve.command_kpa(y_mm + 1) - curve.command_kpa(y_mm), needed_kpa + 1e-9) << y_mm;
  }
  EXPECT_LT(needed_kpa, 3)
      << "the computed gripping pressure is at most slightly larger than the required pressure";
}

TEST(FreeCurve, AModelThatDoesNotMoveNeedsTheLowestCommand) {
  model::Model model = model_named("bench_twin");
  auto values = model::flat_values(model);
  for (const char* gain : {"bouc_wen.alpha_mm_per_kpa", "bouc_wen.beta_mm_per_kpa"}) {
    values[model::find_path(model, gain).value()] = 0;
  }
  for (const char* stiffness : {"k0_kpa_per_mm", "k1_kpa_per_mm", "k2_kpa_per_mm"}) {
    values[model::find_path(model, std::string("kelvin_voigt.") + stiffness).value()] = 1e300;
  }
  const FreeCurve curve(model::with_values(model, values), limits);
  EXPECT_NEAR(curve.command_kpa(0), limits.pressure_min_kpa, 1e-6);
}

// The displacement of this finger decreases with the pressure, so the highest point of the curve is the first
// point.
TEST(FreeCurve, AModelWithNegativeGainReturnsTheLowestCommand) {
  model::Model backwards = model::only(model_named("bench_twin"),
                                       [](const model::BlockInfo& info) { return info.id == "bouc_wen"; });
  auto values = model::flat_values(backwards);
  values[model::find_path(backwards, "bouc_wen.alpha_mm_per_kpa").value()] = -0.2;
  values[model::find_path(backwards, "bouc_wen.beta_mm_per_kpa").value()] = 0;
  LimitSettings raised = limits;
  raised.pressure_min_kpa = 4;
  const FreeCurve curve(model::with_values(backwards, values), raised);
  for (const double y_mm : {-12.0, -0.8, 0.0, 12.0}) {
    EXPECT_EQ(curve.command_kpa(y_mm), 4) << y_mm;
    EXPECT_EQ(curve.pressure_kpa(y_mm), 4) << y_mm;
  }
  EXPECT_EQ(curve.squeeze_for_kpa(1), 0);
}

TEST(FreeCurve, WithoutAValveTheCommandIsThePressure) {
  const model::Model finger = model_named("bench_twin");
  const FreeCurve bare(body_of(finger), limits);
  const FreeCurve valved(finger, limits);
  for (double y_mm = 1; y_mm < 25; y_mm += 3) {
    EXPECT_EQ(bare.command_kpa(y_mm), bare.pressure_kpa(y_mm)) << y_mm;
    EXPECT_NEAR(bare.command_kpa(y_mm), valved.command_kpa(y_mm), 0.05)
        << y_mm << " mm: at rest, the lag of the valve has no effect";
  }
}

TEST(FreeMotion, HighestDisplacementAgreesWithTheFreeCurve) {
  const LimitSettings rig_limits = two_finger_settings().channels[0].limits;
  const FreeMotion motion = free_motion(twin(), rig_limits);
  EXPECT_GT(motion.highest_mm, motion.lowest_mm + 5);
  EXPECT_NEAR(FreeCurve(twin(), rig_limits).command_kpa(motion.highest_mm), rig_limits.pressure_max_kpa, 1.5);
}

TEST(FreeMotion, SlowerSlewLimitsReduceTheFastestMotion) {
  LimitSettings rig_limits = two_finger_settings().channels[0].limits;
  rig_limits.slew_up_kpa_per_s = rig_limits.slew_down_kpa_per_s = 1000;
  const FreeMotion fast = free_motion(twin(), rig_limits);
  rig_limits.slew_up_kpa_per_s = rig_limits.slew_down_kpa_per_s = 5;
  const FreeMotion slow = free_motion(twin(), rig_limits);
  EXPECT_GT(fast.fastest_mm_per_s, 5 * slow.fastest_mm_per_s);
  EXPECT_GT(slow.fastest_mm_per_s, 5 * (slow.highest_mm - slow.lowest_mm) / rig_limits.pressure_max_kpa);
  EXPECT_NEAR(fast.highest_mm, slow.highest_mm, 0.1 * slow.highest_mm);
}

TEST(FreeMotion, AModelWithoutAValveMovesFasterToTheSameEnd) {
  LimitSettings rig_limits = two_finger_settings().channels[0].limits;
  rig_limits.pressure_min_kpa = 6;
  rig_limits.slew_up_kpa_per_s = rig_limits.slew_down_kpa_per_s = 1000;
  const model::Model body = body_of(twin());
  const FreeMotion bare = free_motion(body, rig_limits);
  const FreeMotion valved = free_motion(twin(), rig_limits);
  EXPECT_NEAR(bare.highest_mm, valved.highest_mm, 0.01 * valved.highest_mm)
      << "the lag of the valve does not change the settled displacement at the highest pressure";
  EXPECT_GT(bare.fastest_mm_per_s, 1.5 * valved.fastest_mm_per_s)
      << "the finger is faster without the lag of the valve";
  model::Chain<double> resting(body);
  resting.reset(rig_limits.pressure_min_kpa);
  resting.step(0, rig_limits.pressure_min_kpa);
  EXPECT_EQ(bare.lowest_mm, resting.reading_mm());
}

}  // namespace
}  // namespace softgrip::control::free_curve_test
