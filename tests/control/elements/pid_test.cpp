#include "control/elements/pid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "control/elements/limits.h"

namespace softgrip::control::pid_test {
namespace {

constexpr double tick_s = 0.005;
constexpr PidSettings typical{2, 8, 0.1, 0.02, 1, AntiWindup::back_calculation, 0.2};

// Simulates a finger without hysteresis. The gain of the finger is 0.4 mm/kPa, and its time constant is 0.3
// s.
struct Finger {
  double y_mm = 0;
  void step(double command_kpa) { y_mm += (0.4 * command_kpa - y_mm) * -std::expm1(-tick_s / 0.3); }
};

// Returns the time [s] from the change to a reachable reference until the finger stays within 0.3 mm of this
// reference. An unreachable reference is active for `saturated_s` before the change. The feedforward command
// is `feedforward_share` times the steady-state pressure for the active reference.
double recovery_s(AntiWindup anti_windup, double feedforward_share, double saturated_s,
                  const LimitSettings& limits) {
  PidSettings settings = typical;
  settings.anti_windup = anti_windup;
  Pid pid(settings, tick_s);
  Finger finger;
  double command = 0;
  double recovered_s = 0;
  pid.align(0);
  const int saturated = static_cast<int>(saturated_s / tick_s);
  for (int i = 0; i < saturated + 12000; ++i) {
    // 40 mm need 100 kPa, which the limits do not permit within saturated_s.
    const double reference = i < saturated ? 40 : 16;
    const double feedforward = feedforward_share * reference / 0.4;
    const double request = feedforward + pid.step(reference, finger.y_mm, feedforward);
    command = limit(limits, request, command, tick_s).command_kpa;
    pid.sent(command);
    finger.step(command);
    if (i >= saturated && std::abs(finger.y_mm - reference) > 0.3) recovered_s = (i - saturated) * tick_s;
  }
  return recovered_s;
}

TEST(Pid, ProportionalActsOnTheWeightedSetpoint) {
  PidSettings settings{2, 0, 0, 0, 0.5, AntiWindup::none, 1};
  Pid pid(settings, tick_s);
  EXPECT_DOUBLE_EQ(pid.step(10, 4, 0), 2 * (5.0 - 4));
}

TEST(Pid, IntegralUsesTheTrapezoidalRule) {
  Pid pid({0, 3, 0, 0, 1, AntiWindup::none, 1}, tick_s);
  double exact = 0;
  for (int i = 0; i <= 1000; ++i) {
    const double t = i * tick_s;
    (void)pid.step(2 * t, 0, 0);  // the error rises linearly, so the trapezoidal integral is exact
    exact = 3 * t * t;
  }
  EXPECT_NEAR(pid.integral_kpa(), exact, 1e-9);
}

TEST(Pid, DerivativeIsExactOnARamp) {
  const double filter = 0.05;
  Pid pid({0, 0, 2, filter, 1, AntiWindup::none, 1}, tick_s);
  for (int i = 0; i <= 100; ++i) {
    const double t = i * tick_s;
    EXPECT_NEAR(pid.step(0, 3 * t, 0), -2 * 3 * (1 - std::exp(-t / filter)), 1e-12);
  }
}

TEST(Pid, DerivativeIgnoresTheReference) {
  Pid pid({0, 0, 2, 0.01, 1, AntiWindup::none, 1}, tick_s);
  (void)pid.step(0, 1, 0);
  EXPECT_EQ(pid.step(20, 1, 0), 0);
}

TEST(Pid, AntiWindupRecoveryDoesNotDependOnSaturationTime) {
  const LimitSettings limits{0, 60, 1000, 1000, 0, 50, 1};
  for (const double share : {0.0, 0.4, 0.7}) {
    SCOPED_TRACE(share);
    const double none = recovery_s(AntiWindup::none, share, 2, limits);
    EXPECT_GT(recovery_s(AntiWindup::none, share, 8, limits), none + 3)
        << "the command is saturated for too short a time in this case to test the anti-windup";
    for (const AntiWindup anti_windup : {AntiWindup::conditional, AntiWindup::back_calculation}) {
      const double soon = recovery_s(anti_windup, share, 2, limits);
      EXPECT_NEAR(recovery_s(anti_windup, share, 8, limits), soon, 0.05);
      EXPECT_LT(soon, 0.6 * none);
    }
  }
}

TEST(Pid, AntiWindupShortensRecoveryFromTheSlewLimits) {
  const LimitSettings slow{0, 200, 15, 15, 0, 100, 1};
  const double none = recovery_s(AntiWindup::none, 0, 4, slow);
  EXPECT_LT(recovery_s(AntiWindup::conditional, 0, 4, slow), 0.8 * none);
  EXPECT_LT(recovery_s(AntiWindup::back_calculation, 0, 4, slow), 0.8 * none);
}

TEST(Pid, AnAlignedStartContinuesTheCommand) {
  Pid pid(typical, tick_s);
  pid.align(31.7);
  const double feedforward = 12;
  EXPECT_NEAR(feedforward + pid.step(20, 3, feedforward), 31.7, 1e-12);
  // The error remains 17 mm, so only the integral action changes the next command: by 8 kPa/(mm s) times the
  // error times the tick.
  const double next = feedforward + pid.step(20, 3, feedforward);
  EXPECT_NEAR(next, 31.7 + 8 * tick_s * 17, 1e-9);
}

TEST(Pid, AlignKeepsTheFeedbackUntilTheFirstMeasurement) {
  Pid pid(typical, tick_s);
  pid.align(25);
  EXPECT_NEAR(10 + pid.hold(10), 25, 1e-12);
  pid.sent(25);
  EXPECT_NEAR(11 + pid.hold(11), 26, 1e-12);
  pid.sent(26);
  EXPECT_NEAR(11 + pid.step(4, 9, 11), 26, 1e-12);
}

TEST(Pid, AGapInTheReadingsHoldsTheFeedback) {
  Pid pid(typical, tick_s);
  double feedback = 0;
  for (int i = 0; i < 50; ++i) feedback = pid.step(10, 4 + 0.02 * i, 0);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(pid.hold(0), feedback);
  EXPECT_NEAR(pid.step(10, 4.98, 0), feedback, 0.5);
}

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(Pid, AnArgumentThatIsNotFiniteHasTheEffectOfAMissingMeasurement) {
  const auto after = [](double reference_mm, double measurement_mm, double feedforward_kpa, bool holds) {
    PidSettings settings = typical;
    settings.derivative_filter_s = 0;
    Pid pid(settings, tick_s);
    for (int i = 0; i < 20; ++i) (void)pid.step(10, 4 + 0.02 * i, 3);
    EXPECT_TRUE(std::isfinite(holds ? pid.hold(3) : pid.step(reference_mm, measurement_mm, feedforward_kpa)));
    pid.sent(30);
    return pid.step(10, 4.5, 3);
  };
  for (const double bad : {nan, infinity, -infinity}) {
    SCOPED_TRACE(bad);
    EXPECT_EQ(after(10, bad, 3, false), after(0, 0, 0, true));
    EXPECT_EQ(after(bad, 4, 3, false), after(0, 0, 0, true));
    EXPECT_TRUE(std::isfinite(after(10, 4, bad, false)));
  }
}

TEST(Pid, ACommandThatIsNotFiniteIsIgnored) {
  for (const double bad : {nan, infinity, -infinity}) {
    SCOPED_TRACE(bad);
    Pid pid(typical, tick_s);
    pid.align(25);
    pid.align(bad);
    pid.sent(bad);
    EXPECT_TRUE(std::isfinite(pid.hold(bad)));
    pid.sent(bad);
    EXPECT_NEAR(10 + pid.step(20, 3, 10), 25, 1e-12);
    pid.sent(bad);
    EXPECT_NEAR(10 + pid.step(20, 3, 10), 25 + 8 * tick_s * 17, 1e-9);
  }
}

TEST(Pid, SaturationLeavesNoBiasWithoutAnIntegralPart) {
  Pid pid({2, 0, 0, 0, 1, AntiWindup::back_calculation, 0.2}, tick_s);
  for (int i = 0; i < 1000; ++i) {
    (void)pid.step(40, 0, 0);
    pid.sent(60);
  }
  EXPECT_DOUBLE_EQ(pid.step(1, 0, 0), 2);
}

}  // namespace
}  // namespace softgrip::control::pid_test
