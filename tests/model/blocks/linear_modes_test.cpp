#include "model/blocks/linear_modes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>

#include "model/blocks/inertia.h"
#include "tests/model/drive.h"

namespace softgrip::model::testing::linear_modes_test {
namespace {

using Block = LinearModes<double>;

// The expected values come from a numerical integration by SciPy (solve_ivp, DOP853, relative tolerance
// 1e-12). The block has an oscillating mode, a mode with two real poles, and a negative static gain.
TEST(LinearModes, RampAndHoldAreThoseOfANumericalIntegration) {
  Block block = make<Block>({0.15, 0.2, 0.1, 0.5, -0.3, 0.6, 3.0, -0.8, 0.4});
  constexpr std::array<std::pair<double, double>, 6> expected{{{0.1, 1.035965286},
                                                               {0.3, 3.432942482},
                                                               {0.5, 4.874347220},
                                                               {0.6, 4.399380275},
                                                               {1.0, 1.170388204},
                                                               {2.0, -1.317240251}}};
  double time_s = 0, pressure_kpa = 0;
  for (const auto& [until_s, displacement_mm] : expected) {
    const double next_kpa = std::fmin(24 * until_s, 12);
    EXPECT_NEAR(move(block, pressure_kpa, next_kpa, until_s - time_s), displacement_mm, 1e-8) << until_s;
    time_s = until_s;
  }
}

TEST(LinearModes, AModeWithUnitGainIsTheInertia) {
  Block block = make<Block>({0, 0.13, 0.3, 1, 0});
  auto inertia = make<Inertia<double>>({0.13, 0.3});
  const Segment<double> in{0.05, 0, 4, 2 + 1.2 / 6};
  const Segment<double> out = block.step(in, {});
  const auto expected = pass(inertia, in);
  EXPECT_NEAR(out.end, expected[0].end, 1e-12);
  EXPECT_NEAR(out.mean, expected[0].mean, 1e-12);
}

TEST(LinearModes, MeanIsThatOfShortSegments) {
  for (const double damping_ratio : {0.1, 1.0, 40.0}) {
    Block once = make<Block>({0.2, 0.3, damping_ratio, 0.4, -0.7}), often = once;
    const Segment<double> out = once.step(Segment<double>::straight(0.4, 0, 10), {});
    double mean = 0;
    for (int i = 0; i < 1000; ++i)
      mean += often.step(Segment<double>::straight(0.0004, 0.01 * i, 0.01 * (i + 1)), {}).mean / 1000;
    EXPECT_NEAR(out.end, often.output(), 1e-9) << damping_ratio;
    EXPECT_NEAR(out.mean, mean, 1e-9) << damping_ratio;
  }
}

// The formulas for two complex poles, a double pole and two real poles meet at the damping ratio 1.
TEST(LinearModes, TheResponseIsContinuousAtTheDampingRatioOne) {
  const auto response = [](double damping_ratio) {
    Block block = make<Block>({0, 0.3, damping_ratio, 1, 0.5});
    block.step(Segment<double>::straight(0, 0, 10), {});
    block.step(Segment<double>::straight(0.07, 10, 10), {});
    return block.output();
  };
  for (const double distance : {1e-9, 4e-7, 6e-7, 1e-5}) {
    EXPECT_NEAR(response(1 - distance), response(1), 20 * distance) << distance;
    EXPECT_NEAR(response(1 + distance), response(1), 20 * distance) << distance;
    EXPECT_NEAR(response(1 - distance) + response(1 + distance), 2 * response(1), 1e-8) << distance;
  }
}

TEST(LinearModes, AJumpOfThePressureMovesOnlyTheDirectPart) {
  Block block = make<Block>({0.2, 0.3, 0.5, 1, 2});
  const Segment<double> out = block.step(Segment<double>::straight(0, 0, 10), {});
  EXPECT_EQ(out.begin, 0);
  EXPECT_NEAR(out.end, 2, 1e-12);
}

}  // namespace
}  // namespace softgrip::model::testing::linear_modes_test
