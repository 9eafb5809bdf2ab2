#include "model/blocks/valve_lag.h"

#include <gtest/gtest.h>

#include "tests/model/drive.h"

namespace softgrip::model::testing::valve_lag_test {
namespace {

using Block = ValveLag<double>;

TEST(ValveLag, StepAndRampResponsesMatchTheAnalyticalSolution) {
  for (const double t : {1e-6, 0.01, 0.5, 30.0}) {
    Block step = make<Block>({0.05});
    pass(step, Segment<double>::straight(0, 0, 8));
    EXPECT_EQ(step.output(), 0);
    pass(step, Segment<double>::straight(t, 8, 8));
    EXPECT_NEAR(step.output(), -8 * std::expm1(-t / 0.05), 1e-13);
    Block ramp = make<Block>({0.05});
    pass(ramp, Segment<double>::straight(t, 0, 3 * t));
    EXPECT_NEAR(ramp.output(), 3 * (t + 0.05 * std::expm1(-t / 0.05)), 1e-12);
  }
}

TEST(ValveLag, MeanIsExact) {
  // For every input u and output y of a lag, tau (y1 - y0) = dt (mean(u) - mean(y)). Here y0 and y1 are the
  // outputs at the start and the end of a step of duration dt.
  Block block = make<Block>({0.05});
  double from = 0;
  for (const double to : {5.0, 9.0, 9.0, 2.0, 1.0, 30.0}) {
    const double before = block.output();
    double integral = 0;
    for (const auto& s : pass(block, Segment<double>::straight(0.02, from, to)))
      integral += s.mean * s.duration_s;
    EXPECT_NEAR(0.05 * (block.output() - before), 0.02 * 0.5 * (from + to) - integral, 1e-14);
    from = to;
  }
}

TEST(ValveLag, OutputPeaksWhereTheInputEqualsTheOutput) {
  Block block = make<Block>({0.05});
  pass(block, Segment<double>::straight(0.2, 0, 20));
  const auto out = pass(block, Segment<double>::straight(0.2, 20, 0));
  ASSERT_EQ(out.size(), 2u);
  const double turn = out[0].duration_s;
  EXPECT_NEAR(out[0].end, 20 - 100 * turn,
              1e-12);  // the output of a lag has its maximum where output and input are equal
  EXPECT_GT(out[0].end, out[0].begin);
  EXPECT_LT(out[1].end, out[1].begin);
  // Before and after the maximum, the output is lower than at the maximum.
  for (const double t : {turn * 0.9, turn * 1.1}) {
    Block other = make<Block>({0.05});
    pass(other, Segment<double>::straight(0.2, 0, 20));
    pass(other, Segment<double>::straight(t, 20, 20 - 100 * t));
    EXPECT_LT(other.output(), out[0].end);
  }
}

TEST(ValveLag, EverySegmentIsMonotoneAndContainsTheMean) {
  Block block = make<Block>({0.03});
  double from = 0;
  for (int i = 0; i < 3000; ++i) {
    const double to = 30 + 25 * std::sin(0.37 * i) * std::cos(0.011 * i);
    for (const auto& s : pass(block, Segment<double>::straight(0.004 + 0.003 * (i % 7), from, to))) {
      ASSERT_GE(s.mean, std::fmin(s.begin, s.end) - 1e-9);
      ASSERT_LE(s.mean, std::fmax(s.begin, s.end) + 1e-9);
    }
    from = to;
  }
}

TEST(ValveLag, StepSizeDoesNotMatter) {
  Block once = make<Block>({0.044}), often = make<Block>({0.044});
  double a = 0;
  for (const double to : {40.0, 35.0, 10.0, 50.0}) {
    pass(once, Segment<double>::straight(0.5, a, to));
    for (int i = 0; i < 100; ++i) {
      pass(often, Segment<double>::straight(0.005, a + (to - a) * i / 100, a + (to - a) * (i + 1) / 100));
    }
    EXPECT_NEAR(once.output(), often.output(), 1e-12);
    a = to;
  }
}

TEST(ValveLag, FollowsTheInputIfMuchFasterThanTheSampleTime) {
  Block block = make<Block>({1e-7});
  const auto out = pass(block, Segment<double>::straight(0.01, 0, 10));
  EXPECT_NEAR(out.back().end, 10, 1e-3);
  EXPECT_NEAR(out.back().mean, 5, 1e-3);
}

}  // namespace
}  // namespace softgrip::model::testing::valve_lag_test
