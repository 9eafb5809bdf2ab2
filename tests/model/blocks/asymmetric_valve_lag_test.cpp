#include "model/blocks/asymmetric_valve_lag.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "model/blocks/chamber_lag.h"
#include "model/blocks/valve_lag.h"
#include "model/two_way_lag.h"
#include "tests/model/drive.h"

namespace softgrip::model::testing::asymmetric_valve_lag_test {
namespace {

using Block = AsymmetricValveLag<double>;

TEST(AsymmetricValveLag, FillingAndVentingHaveSeparateTimeConstants) {
  Block block = make<Block>({0.05, 0.4});
  pass(block, Segment<double>::straight(0, 0, 8));
  pass(block, Segment<double>::straight(0.1, 8, 8));
  EXPECT_NEAR(block.output(), 8 * -std::expm1(-0.1 / 0.05), 1e-13);
  const double high = block.output();
  pass(block, Segment<double>::straight(0, 8, 0));
  pass(block, Segment<double>::straight(0.1, 0, 0));
  EXPECT_NEAR(block.output(), high * std::exp(-0.1 / 0.4), 1e-13);
}

TEST(AsymmetricValveLag, EqualsTheValveLagForEqualTimeConstants) {
  std::mt19937_64 random(21);
  std::uniform_real_distribution<double> pressure(0, 60), duration(0.001, 0.3);
  Block both = make<Block>({0.07, 0.07});
  auto one = make<ValveLag<double>>({0.07});
  double at = 0;
  for (int i = 0; i < 500; ++i) {
    const double to = pressure(random), lasts = duration(random);
    pass(both, Segment<double>::straight(lasts, at, to));
    pass(one, Segment<double>::straight(lasts, at, to));
    ASSERT_NEAR(both.output(), one.output(), 1e-9) << "seed 21, step " << i;
    at = to;
  }
}

TEST(AsymmetricValveLag, AgreesWithASmallStepIntegrator) {
  // The reference solution is computed by the explicit midpoint method in steps of 10 us, without an
  // exponential function.
  std::mt19937_64 random(22);
  std::uniform_real_distribution<double> pressure(0, 60), duration(0.01, 0.2);
  Block block = make<Block>({0.06, 0.3});
  double at = 0, p = 0;
  for (int i = 0; i < 60; ++i) {
    const double to = pressure(random), lasts = duration(random);
    const auto rate = [](double u, double y) { return (u - y) / (u > y ? 0.06 : 0.3); };
    const int count = static_cast<int>(lasts / 1e-5);
    const double h = lasts / count;
    for (int k = 0; k < count; ++k) {
      const double u = at + (to - at) * k / count, middle = at + (to - at) * (k + 0.5) / count;
      p += h * rate(middle, p + 0.5 * h * rate(u, p));
    }
    pass(block, Segment<double>::straight(lasts, at, to));
    ASSERT_NEAR(block.output(), p, 1e-6) << "seed 22, step " << i;
    at = to;
  }
}

TEST(AsymmetricValveLag, FollowsAtOnceInADirectionWithoutLag) {
  Block block = make<Block>({0, 0.3});
  pass(block, Segment<double>::straight(0.1, 0, 10));
  EXPECT_EQ(block.output(), 10);
  pass(block, Segment<double>::straight(0, 10, 20));
  EXPECT_EQ(block.output(), 20);
  pass(block, Segment<double>::straight(0, 20, 0));
  EXPECT_EQ(block.output(), 20);
}

TEST(ChamberLag, HasTheSameResponseAsTheAsymmetricValveLag) {
  auto chamber = make<ChamberLag<double>>({0.05, 0.4});
  Block valve = make<Block>({0.05, 0.4});
  for (const auto& [from, to] : {std::pair{0.0, 30.0}, {30.0, 5.0}, {5.0, 12.0}}) {
    pass(chamber, Segment<double>::straight(0.2, from, to));
    pass(valve, Segment<double>::straight(0.2, from, to));
    EXPECT_EQ(chamber.output(), valve.output());
  }
}

}  // namespace
}  // namespace softgrip::model::testing::asymmetric_valve_lag_test
