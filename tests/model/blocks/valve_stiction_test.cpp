#include "model/blocks/valve_stiction.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "tests/model/drive.h"

namespace softgrip::model::testing::valve_stiction_test {
namespace {

using Block = ValveStiction<double>;

Block sticking(double band_kpa) {
  return make<Block>({band_kpa});
}

TEST(ValveStiction, OutputIsConstantUntilTheCommandLeavesTheStickBand) {
  Block block = sticking(2.0);
  const std::vector<double> in{1.5, 2.5, 4.0, 3.0, 1.5, 1.0, 2.5, 9.0};
  EXPECT_EQ(drive(block, 0, in, 1.0), (std::vector<double>{0, 2, 2, 2, 2, 2, 2, 8}));
}

TEST(ValveStiction, SeveralJumpsWithinASegmentOccurAtTheCorrectTimes) {
  Block block = sticking(2.0);
  const auto out = pass(block, Segment<double>::straight(1.0, 0, 5));
  ASSERT_EQ(out.size(), 5u);
  EXPECT_NEAR(out[0].duration_s, 0.4, 1e-15);
  EXPECT_EQ(out[0].end, 0);
  EXPECT_EQ(out[1].duration_s, 0);
  EXPECT_EQ(out[1].end, 2);
  EXPECT_NEAR(out[2].duration_s, 0.4, 1e-15);
  EXPECT_EQ(out[2].mean, 2);
  EXPECT_EQ(out[3].end, 4);
  EXPECT_NEAR(out[4].duration_s, 0.2, 1e-15);
  EXPECT_EQ(block.output(), 4);
}

TEST(ValveStiction, StaircaseDoesNotDependOnTheStepSize) {
  Block once = sticking(2.3), often = sticking(2.3);
  double from = 0;
  for (const double to : {12.0, 11.0, 3.0, 8.0, 7.5, 40.0, 0.0}) {
    pass(once, Segment<double>::straight(1.0, from, to));
    std::vector<double> fine;
    for (int i = 1; i <= 50; ++i) fine.push_back(from + (to - from) * i / 50);
    drive(often, from, fine, 0.02);
    EXPECT_NEAR(once.output(), often.output(), 1e-12);
    from = to;
  }
}

// Compares the block with the usual algorithm, which compares the command with the held value at many sample
// times. The usual algorithm detects a jump slightly late, and its jump is slightly too large. The two
// outputs may therefore differ when the command is close to the threshold of a jump.
TEST(ValveStiction, AgreesWithADenselySampledSlipJumpModel) {
  constexpr double band = 1.7;
  Block block = sticking(band);
  double held = 0, from = 0;
  for (const double to : {30.0, 22.0, 25.0, 3.0, 3.0, 55.0, 54.0, 0.0}) {
    for (int i = 1; i <= 200000; ++i) {
      const double u = from + (to - from) * i / 200000;
      if (std::fabs(u - held) > band) held = u;
      if (i % 1000 != 0) continue;
      const double before = from + (to - from) * (i - 1000) / 200000;
      pass(block, Segment<double>::straight(0.01, before, u));
      if (std::fabs(block.output() - held) < 0.05) continue;
      ASSERT_LT(std::fmin(std::fabs(u - held), std::fabs(u - block.output())), 0.05);
      ASSERT_GT(std::fmax(std::fabs(u - held), std::fabs(u - block.output())), band - 0.05);
    }
    from = to;
  }
}

TEST(ValveStiction, FollowsAFastCommandWithoutSticking) {
  Block block = sticking(2.0);
  const auto out = pass(block, Segment<double>::straight(0.005, 0, 49));
  ASSERT_EQ(out.size(), 3u);  // three segments: the time until the valve breaks free, the jump, and the rest
  EXPECT_NEAR(out[0].duration_s, 0.005 * 2 / 49, 1e-15);
  EXPECT_EQ(block.output(), 49);
  const auto on = pass(block, Segment<double>::straight(0.0005, 49, 50));
  ASSERT_EQ(on.size(), 1u);
  EXPECT_EQ(block.output(), 50);
  pass(block, Segment<double>::straight(0.0, 50, 48.5));
  EXPECT_EQ(block.output(), 50);
  pass(block, Segment<double>::straight(0.0, 48.5, 20));
  EXPECT_EQ(block.output(), 20);
}

TEST(ValveStiction, HasNoEffectWithoutAStickBand) {
  Block block = sticking(0.0);
  for (const double dt : {0.0, 1e-3, 1.0}) {
    block.reset(5.0);
    const auto out = pass(block, Segment<double>{dt, 5, 9, 7.3});
    ASSERT_EQ(out.size(), 1u);
    EXPECT_EQ(out[0].end, 9);
    EXPECT_EQ(out[0].mean, 7.3);
  }
}

TEST(ValveStiction, PreservesDurationAndContinuity) {
  Block block = sticking(1.3);
  std::mt19937 generator(17);
  std::uniform_real_distribution<double> value(-5, 60), length(1e-4, 0.2);
  double last = block.output(), from = 0;
  for (int i = 0; i < 5000; ++i) {
    const double to = i % 5 == 0 ? from : value(generator);
    const double dt = i % 7 == 0 ? 0 : length(generator);
    double sum = 0;
    for (const Segment<double>& s : pass(block, Segment<double>::straight(dt, from, to))) {
      ASSERT_NEAR(s.begin, last, 1e-9);
      ASSERT_GE(s.duration_s, 0);
      last = s.end;
      sum += s.duration_s;
    }
    from = to;
    ASSERT_NEAR(sum, dt, 1e-9);
    ASSERT_EQ(block.output(), last);
    ASSERT_LE(std::fabs(block.output() - to), 1.3 + 1e-9);
  }
}

TEST(ValveStiction, ResetReachesTheOutputOfASlowRise) {
  Block rested = sticking(1.3), risen = sticking(1.3);
  rested.reset(35.0);
  pass(risen, Segment<double>::straight(10, 0, 35));
  EXPECT_NEAR(rested.output(), risen.output(), 1e-9);
}

}  // namespace
}  // namespace softgrip::model::testing::valve_stiction_test
