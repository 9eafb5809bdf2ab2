#include "model/blocks/inertia.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/model/drive.h"

namespace softgrip::model::testing::inertia_test {
namespace {

using Block = Inertia<double>;

TEST(Inertia, StepResponseMatchesTheAnalyticalSolution) {
  Block block = make<Block>({0.2, 0.1});
  pass(block, Segment<double>::straight(0, 0, 5));
  EXPECT_EQ(block.output(), 0);
  const double w = 2 * std::numbers::pi / 0.2, d = 0.1 * w, wd = w * std::sqrt(1 - 0.01);
  for (int i = 1; i <= 400; ++i) {
    pass(block, Segment<double>::straight(0.005, 5, 5));
    const double t = 0.005 * i;
    ASSERT_NEAR(block.output(), 5 * (1 - std::exp(-d * t) * (std::cos(wd * t) + d / wd * std::sin(wd * t))),
                1e-11);
  }
}

TEST(Inertia, RampResponseIsIndependentOfTheStepSize) {
  Block once = make<Block>({0.13, 0.3}), often = make<Block>({0.13, 0.3});
  double mean = 0;
  const auto out = pass(once, Segment<double>::straight(0.5, 0, 12));
  for (int i = 0; i < 1000; ++i) {
    for (const auto& s : pass(often, Segment<double>::straight(0.0005, 0.012 * i, 0.012 * (i + 1)))) {
      mean += s.mean / 1000;
    }
  }
  EXPECT_NEAR(once.output(), often.output(), 1e-10);
  EXPECT_NEAR(out[0].mean, mean, 1e-10);
}

TEST(Inertia, VeryShortSegmentsDoNotChangeTheOutput) {
  Block whole = make<Block>({0.13, 0.3}), pieces = make<Block>({0.13, 0.3});
  for (int i = 0; i < 300; ++i) {
    const double a = 0.02 * i, b = 0.02 * (i + 1);
    pass(whole, Segment<double>::straight(0.001, a, b));
    double from = a, t = 0;
    for (const double to_s : {1e-13, 1e-10, 1e-8, 1e-3}) {
      const double to = a + (b - a) * to_s / 1e-3;
      pass(pieces, Segment<double>::straight(to_s - t, from, to));
      from = to;
      t = to_s;
    }
    ASSERT_NEAR(whole.output(), pieces.output(), 1e-9);
  }
}

TEST(Inertia, RespondsToTheCurvatureOfTheInput) {
  Block curved = make<Block>({0.1, 0.3}), pieces = make<Block>({0.1, 0.3});
  const Segment<double> in{0.05, 0, 4, 2 + 1.2 / 6};
  pass(curved, in);
  double from = 0;
  for (int i = 1; i <= 2000; ++i) {
    const double to = in.at(i / 2000.0);
    pass(pieces, Segment<double>::straight(0.05 / 2000, from, to));
    from = to;
  }
  EXPECT_NEAR(curved.output(), pieces.output(), 1e-6);
}

}  // namespace
}  // namespace softgrip::model::testing::inertia_test
