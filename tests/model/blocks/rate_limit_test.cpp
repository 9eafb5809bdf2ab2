#include "model/blocks/rate_limit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include "model/dual.h"
#include "tests/model/drive.h"

namespace softgrip::model::testing::rate_limit_test {
namespace {

using Block = RateLimit<double>;

TEST(RateLimit, RisesAndFallsAtTheStatedRates) {
  Block block = make<Block>({0.1, 0.25});  // 10 kPa/s for rising pressure, 4 kPa/s for falling pressure
  pass(block, Segment<double>::straight(0, 0, 8));
  pass(block, Segment<double>::straight(0.5, 8, 8));
  EXPECT_NEAR(block.output(), 5, 1e-12);
  pass(block, Segment<double>::straight(0.5, 8, 8));
  EXPECT_NEAR(block.output(), 8, 1e-12);
  pass(block, Segment<double>::straight(0, 8, 0));
  pass(block, Segment<double>::straight(1, 0, 0));
  EXPECT_NEAR(block.output(), 4, 1e-12);
}

TEST(RateLimit, DividesTheSegmentInWhichThePressureMeetsTheCommand) {
  Block block = make<Block>({0.1, 0.1});
  pass(block, Segment<double>::straight(0, 0, 6));
  const auto out = pass(block, Segment<double>::straight(1, 6, 5));  // pressure and command approach each
                                                                     // other at 11 kPa/s
  ASSERT_EQ(out.size(), 2U);
  EXPECT_NEAR(out[0].duration_s, 6.0 / 11, 1e-12);
  EXPECT_NEAR(out[0].end, 60.0 / 11, 1e-12);
  EXPECT_NEAR(out[1].duration_s, 5.0 / 11, 1e-12);
  EXPECT_NEAR(out[1].end, 5, 1e-12);
}

TEST(RateLimit, FollowsAtOnceInADirectionWithoutLimit) {
  Block block = make<Block>({0, 0.1});
  pass(block, Segment<double>::straight(0, 0, 20));
  EXPECT_EQ(block.output(), 20);
  pass(block, Segment<double>::straight(0, 20, 0));
  EXPECT_EQ(block.output(), 20);
  pass(block, Segment<double>::straight(1, 0, 0));
  EXPECT_NEAR(block.output(), 10, 1e-12);
}

// The reference solution moves its output towards the command in steps of 10 us, within the rate limits.
TEST(RateLimit, AgreesWithASmallStepIntegrator) {
  std::mt19937_64 random(23);
  std::uniform_real_distribution<double> pressure(0, 60), duration(0.01, 0.4);
  Block block = make<Block>({0.01, 0.02});
  double at = 0, p = 0;
  int limited = 0;
  for (int i = 0; i < 200; ++i) {
    const double to = pressure(random), lasts = duration(random);
    const int count = static_cast<int>(lasts / 1e-5);
    const double h = lasts / count;
    for (int k = 1; k <= count; ++k) {
      const double u = at + (to - at) * k / count;
      p = std::clamp(u, p - h / 0.02, p + h / 0.01);
    }
    pass(block, Segment<double>::straight(lasts, at, to));
    ASSERT_NEAR(block.output(), p, 2e-3) << "seed 23, step " << i;
    limited += std::abs(p - to) > 1 ? 1 : 0;
    at = to;
  }
  EXPECT_GT(limited, 50);
}

// The input of the rate limit is curved, like the output of a lag. The mean of each output segment must lie
// between the values at the ends of the segment.
TEST(RateLimit, ACurvedInputGivesMonotoneSegments) {
  std::mt19937_64 random(24);
  std::uniform_real_distribution<double> pressure(0, 60), duration(0.01, 0.4), bend(0.02, 0.98);
  Block block = make<Block>({0.01, 0.02});
  double at = 0;
  int divided = 0;
  for (int i = 0; i < 500; ++i) {
    const double to = pressure(random);
    const auto out = pass(block, {duration(random), at, to, at + (to - at) * bend(random)});
    divided += out.size() > 1 ? 1 : 0;
    for (const Segment<double>& s : out) {
      ASSERT_GE(s.mean, std::min(s.begin, s.end) - 1e-9) << "seed 24, step " << i;
      ASSERT_LE(s.mean, std::max(s.begin, s.end) + 1e-9) << "seed 24, step " << i;
    }
    at = to;
  }
  EXPECT_GT(divided, 50);
}

TEST(RateLimit, DerivativesIncludeTheTimeOfReachingTheCommand) {
  const auto run = [](auto filling) {
    using T = decltype(filling);
    const std::vector<T> values{filling, T(0.1)};
    RateLimit<T> block(values, {});
    T mean(0.0);
    for (const auto& [lasts, from, to] : {std::array{0.0, 0.0, 6.0}, {0.2, 6.0, 6.5}, {1.0, 6.5, 5.0}})
      block.step(Segment<T>::straight(T(lasts), T(from), T(to)), {},
                 [&](const Segment<T>& s) { mean += s.mean * s.duration_s; });
    return mean;
  };
  const double step = 1e-6;
  const double difference = (run(0.1 + step) - run(0.1 - step)) / (2 * step);
  EXPECT_LT(difference, -1) << "a slower pressure has a smaller integral";
  EXPECT_NEAR(run(Dual<double>(0.1, 1.0)).v, difference, 1e-6);
}

}  // namespace
}  // namespace softgrip::model::testing::rate_limit_test
