#include "model/blocks/kelvin_voigt.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/model/drive.h"

namespace softgrip::model::testing::kelvin_voigt_test {
namespace {

using Block = KelvinVoigt<double>;

const std::vector<double> two_branches{325.9, 18.0, 246.1, 2.0, 1.2};

TEST(KelvinVoigt, StepResponseMatchesTheAnalyticalSolution) {
  Block block(two_branches, Preparation{});
  double from = 0;
  move(block, from, 40, 0);  // a pressure step, because the duration is 0
  EXPECT_DOUBLE_EQ(block.output(), 40 / 325.9);
  for (const double t : {0.001, 0.3, 2.0, 60.0}) {
    Block one = block;
    double at = from;
    move(one, at, 40, t);
    const double expected =
        40 / 325.9 - 40 / 18.0 * std::expm1(-t * 18.0 / 246.1) - 40 / 2.0 * std::expm1(-t * 2.0 / 1.2);
    EXPECT_NEAR(one.output(), expected, 1e-13);
  }
}

TEST(KelvinVoigt, RampResponseMatchesTheAnalyticalSolution) {
  // Displacement that is expected for a pressure ramp p = r t: x(t) = r/k (t - tau (1 - exp(-t/tau))).
  for (const double t : {1e-4, 0.1, 5.0, 400.0}) {
    Block block = make<Block>({1e9, 2.0, 1.2});
    double from = 0;
    move(block, from, 10 * t, t);
    const double tau = 0.6;
    const double expected = 10 / 2.0 * (t + tau * std::expm1(-t / tau));
    EXPECT_NEAR(block.output(), expected, 1e-12 * std::fmax(1.0, expected) + 10 * t * 1e-9) << t;
  }
}

TEST(KelvinVoigt, ResponsesObeySuperposition) {
  Block a(two_branches, Preparation{}), b(two_branches, Preparation{}), sum(two_branches, Preparation{});
  double pa = 0, pb = 0, ps = 0;
  for (int i = 1; i < 500; ++i) {
    const double u = 20 * std::sin(0.05 * i), v = 0.3 * (i % 70);
    ASSERT_NEAR(move(a, pa, u, 0.01) + move(b, pb, v, 0.01), move(sum, ps, u + v, 0.01), 1e-12);
  }
}

TEST(KelvinVoigt, SettlesAtItsStaticGain) {
  Block block(two_branches, Preparation{});
  double from = 0;
  move(block, from, 50, 1);
  move(block, from, 50, 1e6);
  const double settled = 50 * (1 / 325.9 + 1 / 18.0 + 1 / 2.0);
  EXPECT_NEAR(block.output(), settled, 1e-9);
  block.reset(50.0);
  EXPECT_NEAR(block.output(), settled, 1e-12);
}

TEST(KelvinVoigt, StepSizeDoesNotMatter) {
  for (const double total : {1e-3, 1.0, 1000.0}) {
    Block once(two_branches, Preparation{}), often(two_branches, Preparation{});
    double a = 0, b = 0;
    for (int i = 1; i <= 1000; ++i) move(often, b, 60.0 * i / 1000, total / 1000);
    EXPECT_NEAR(move(once, a, 60, total), often.output(), 1e-11);
  }
}

TEST(KelvinVoigt, ABranchActsAsASpringOrADashpotInTheLimits) {
  // A branch with a very short time constant acts like a spring. A branch with a very long time constant acts
  // like a dashpot with the displacement p t / c. A branch with stiffness 0 must equal this dashpot exactly.
  Block spring = make<Block>({1e9, 5.0, 1e-9});
  double from = 0;
  EXPECT_NEAR(move(spring, from, 30, 0.01), 6.0, 1e-6);
  Block dashpot = make<Block>({1e9, 1e-9, 100.0});
  Block pure = make<Block>({1e9, 0.0, 100.0});
  double a = 0, b = 0;
  for (int i = 0; i < 100; ++i) {
    move(dashpot, a, 30, i == 0 ? 0 : 0.01);
    move(pure, b, 30, i == 0 ? 0 : 0.01);
  }
  EXPECT_NEAR(dashpot.output(), 30 * 0.99 / 100, 1e-6);
  EXPECT_NEAR(dashpot.output(), pure.output(), 1e-9);
}

TEST(KelvinVoigt, RespondsToTheCurvatureOfTheInput) {
  // The input is u(s) = 10 s + 8 s (1 - s) for the time s from 0 to 1 s. The mean of the input is 10/2 + 8/6.
  // The reference solution divides this input into 2000 linear segments.
  Block curved(two_branches, Preparation{}), pieces(two_branches, Preparation{});
  const Segment<double> out = curved.step({1.0, 0.0, 10.0, 5.0 + 8.0 / 6.0}, {});
  double from = 0, integral = 0;
  for (int i = 1; i <= 2000; ++i) {
    const double s = i / 2000.0;
    const double y = pieces.output();
    move(pieces, from, 10 * s + 8 * s * (1 - s), 1.0 / 2000);
    integral += 0.5 * (y + pieces.output()) / 2000;
  }
  EXPECT_NEAR(curved.output(), pieces.output(), 1e-6);
  EXPECT_NEAR(out.mean, integral, 1e-6);
}

TEST(KelvinVoigt, StaticGainIncludesAllEightBranches) {
  std::vector<double> values{300};
  double gain = 1 / 300.0;
  for (int i = 1; i <= 8; ++i) {
    values.push_back(10.0 * i);
    values.push_back(3.0 * i * i);
    gain += 1 / (10.0 * i);
  }
  Block block(values, Preparation{1e-3, 0});
  block.reset(20.0);
  EXPECT_NEAR(block.output(), 20 * gain, 1e-12);
  EXPECT_EQ(block.branches(), 8u);
}

}  // namespace
}  // namespace softgrip::model::testing::kelvin_voigt_test
