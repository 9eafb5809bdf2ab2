#include "control/elements/limits.h"

#include <gtest/gtest.h>

#include <random>

namespace softgrip::control::limits_test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr LimitSettings typical{0, 60, 200, 400, 0, 25, 0.5};

TEST(Limits, PassesACommandWithinAllLimits) {
  const LimitedCommand command = limit(typical, 20.5, 20, 0.005);
  EXPECT_EQ(command.command_kpa, 20.5);
  EXPECT_FALSE(command.saturated || command.slewing || command.invalid);
}

TEST(Limits, SlewIsAsymmetric) {
  EXPECT_DOUBLE_EQ(limit(typical, 60, 20, 0.005).command_kpa, 21);
  EXPECT_DOUBLE_EQ(limit(typical, 0, 20, 0.005).command_kpa, 18);
  EXPECT_TRUE(limit(typical, 0, 20, 0.005).slewing);
}

TEST(Limits, TheCommandMovesToACeilingAtTheSlewLimit) {
  const LimitedCommand capped = limit(typical, 30, 20, 0.05, 25);
  EXPECT_EQ(capped.command_kpa, 25);
  EXPECT_TRUE(capped.capped);
  EXPECT_FALSE(capped.saturated || capped.slewing);
  EXPECT_DOUBLE_EQ(limit(typical, 30, 30, 0.005, 20).command_kpa, 28)
      << "the command falls at a rate of at most 400 kPa/s";
  EXPECT_EQ(limit(typical, 30, 0, 1, -5).command_kpa, 0)
      << "the command is never below the permitted pressure range";
  EXPECT_FALSE(limit(typical, 24, 20, 0.05, 25).capped);
}

TEST(Limits, ANaNCeilingHoldsTheLastCommand) {
  const LimitedCommand command = limit(typical, 40, 33, 0.005, nan);
  EXPECT_EQ(command.command_kpa, 33);
  EXPECT_TRUE(command.invalid);
}

TEST(Limits, ReportsSaturationAndSlewingSeparately) {
  const LimitedCommand range = limit(typical, 61, 60, 0.005);
  EXPECT_EQ(range.command_kpa, 60);
  EXPECT_TRUE(range.saturated);
  EXPECT_FALSE(range.slewing);
  const LimitedCommand both = limit(typical, -10, 20, 0.005);
  EXPECT_TRUE(both.saturated);
  EXPECT_TRUE(both.slewing);
}

TEST(Limits, ANaNRequestHoldsTheCommandAndInfinitySlews) {
  const LimitedCommand command = limit(typical, nan, 33, 0.005);
  EXPECT_EQ(command.command_kpa, 33);
  EXPECT_TRUE(command.invalid);
  EXPECT_EQ(limit(typical, 10, nan, 0.005).command_kpa, 1);
  EXPECT_DOUBLE_EQ(limit(typical, infinity, 33, 0.005).command_kpa, 34);
  EXPECT_TRUE(limit(typical, infinity, 33, 0.005).saturated);
}

TEST(Limits, AnInvalidElapsedTimeHoldsTheLastCommand) {
  for (const double elapsed_s : {-1.0, -0.005, nan, -infinity}) {
    SCOPED_TRACE(elapsed_s);
    for (const double wanted_kpa : {0.0, 33.0, 60.0, infinity}) {
      const LimitedCommand command = limit(typical, wanted_kpa, 33, elapsed_s);
      EXPECT_EQ(command.command_kpa, 33);
      EXPECT_TRUE(command.invalid);
    }
    EXPECT_EQ(limit(typical, 0, 0, elapsed_s).command_kpa, 0);
    EXPECT_EQ(limit(typical, 60, 80, elapsed_s).command_kpa, 60)
        << "the held command is inside the pressure range";
  }
  EXPECT_EQ(limit(typical, 40, 33, 0).command_kpa, 33);
  EXPECT_FALSE(limit(typical, 40, 33, 0).invalid);
  EXPECT_EQ(limit(typical, 40, 33, infinity).command_kpa, 40);
}

TEST(Limits, ClampsTheReferenceAndChecksTheReading) {
  EXPECT_EQ(limit_reference(typical, 26).reference_mm, 25);
  EXPECT_TRUE(limit_reference(typical, 26).clamped);
  EXPECT_FALSE(limit_reference(typical, 25).clamped);
  EXPECT_FALSE(displacement_beyond(typical, 25.4));
  EXPECT_TRUE(displacement_beyond(typical, 25.6));
  EXPECT_TRUE(displacement_beyond(typical, -0.6));
  EXPECT_TRUE(displacement_beyond(typical, nan));
}

constexpr LimitSettings vacuum{-40, 60, 200, 400, -30, 25, 0.5, 0};

TEST(Limits, RestIsZeroOrTheNearestEndOfTheRange) {
  LimitSettings limits = typical;
  EXPECT_EQ(resting_kpa(limits), 0);
  EXPECT_EQ(resting_kpa(vacuum), 0) << "the rest pressure of this channel is not full vacuum";
  limits.pressure_min_kpa = 5;
  EXPECT_EQ(resting_kpa(limits), 5);
  limits.pressure_min_kpa = -80;
  limits.pressure_max_kpa = -10;
  EXPECT_EQ(resting_kpa(limits), -10);
  EXPECT_EQ(far_end_kpa(limits), -80);
  EXPECT_EQ(far_end_kpa(vacuum), 60);
}

TEST(Limits, NoFurtherKeepsThePressureBetweenRestAndBound) {
  EXPECT_EQ(no_further(0, 20, 12), 12);
  EXPECT_EQ(no_further(0, 5, 12), 5);
  EXPECT_EQ(no_further(0, -5, 12), 0)
      << "if the bound is above the rest pressure, the rest pressure is the lower limit";
  EXPECT_EQ(no_further(0, -20, -12), -12);
  EXPECT_EQ(no_further(0, -5, -12), -5);
  EXPECT_EQ(no_further(0, 5, -12), 0)
      << "if the bound is below the rest pressure, the rest pressure is the upper limit";
  EXPECT_EQ(no_further(10, 4, 0), 4);
  EXPECT_EQ(no_further(10, 12, 0), 10);
  EXPECT_EQ(no_further(0, -20, infinity), -20);
}

TEST(Limits, StartsAtRestIfTheLastCommandIsNaN) {
  EXPECT_EQ(limit(vacuum, nan, nan, 0.005).command_kpa, 0);
  EXPECT_EQ(limit(vacuum, -40, nan, 0.005).command_kpa, -2);
}

TEST(Limits, ACeilingNeverPullsTheCommandBelowRest) {
  EXPECT_EQ(limit(vacuum, 30, 1, 1, -20).command_kpa, 0)
      << "the command falls to the rest pressure, but not below it";
  EXPECT_EQ(limit(vacuum, 30, -10, 1, -20).command_kpa, 0)
      << "a ceiling below the rest pressure does not stop the return to the rest pressure";
  EXPECT_EQ(limit(vacuum, 0, -30, 1, -20).command_kpa, 0);
  EXPECT_FALSE(limit(vacuum, 0, -30, 1, -20).capped);
}

// For any sequence of requests, the command must stay within its range and its slew limits.
TEST(Limits, NeverExceededUnderRandomRequests) {
  const unsigned seed = 4711;
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> anything(-200, 300);
  const double wild[] = {nan, infinity, -infinity, 1e300, -1e300, 0, -0.0, 60};
  for (int rig = 0; rig < 50; ++rig) {
    std::uniform_real_distribution<double> low(rig % 2 == 0 ? 0 : -60, 10), span(1, 100), slew(1, 2000);
    LimitSettings limits = typical;
    limits.pressure_min_kpa = low(random);
    limits.pressure_max_kpa = limits.pressure_min_kpa + span(random);
    limits.slew_up_kpa_per_s = slew(random);
    limits.slew_down_kpa_per_s = slew(random);
    limits.rest_kpa = anything(random);
    double last = resting_kpa(limits);
    for (int i = 0; i < 2000; ++i) {
      const double elapsed = 0.001 + 0.01 * static_cast<double>(random() % 10);
      const double wanted = random() % 10 == 0 ? wild[random() % 8] : anything(random);
      const double now = limit(limits, wanted, last, elapsed).command_kpa;
      ASSERT_GE(now, limits.pressure_min_kpa);
      ASSERT_LE(now, limits.pressure_max_kpa);
      ASSERT_LE(now - last, limits.slew_up_kpa_per_s * elapsed * (1 + 1e-12) + 1e-12);
      ASSERT_LE(last - now, limits.slew_down_kpa_per_s * elapsed * (1 + 1e-12) + 1e-12);
      last = now;
    }
  }
}

}  // namespace
}  // namespace softgrip::control::limits_test
