#include "model/blocks/relaxing_friction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/chain.h"
#include "model/dual.h"
#include "tests/model/drive.h"

namespace softgrip::model::testing::relaxing_friction_test {
namespace {

using Block = RelaxingFriction<double>;

// Returns the width of the settled loop at 20 kPa for a triangular pressure between 0 and 40 kPa.
double width(double rate_kpa_per_s) {
  Block block = make<Block>({0.03, 10.0, 1.0});
  double from = 0;
  double up = 0, down = 0;
  for (int cycle = 0; cycle < 5; ++cycle) {
    move(block, from, 20, 20 / rate_kpa_per_s);
    up = block.output();
    move(block, from, 40, 20 / rate_kpa_per_s);
    move(block, from, 20, 20 / rate_kpa_per_s);
    down = block.output();
    move(block, from, 0, 20 / rate_kpa_per_s);
  }
  return down - up;
}

TEST(RelaxingFriction, LoopWidthIncreasesWithTheRateUpToALimit) {
  EXPECT_NEAR(width(0.01), 2 * 0.03 * 0.01,
              1e-5);  // for a slow input, the friction is viscous: half the width is gain * tau * rate
  EXPECT_GT(width(10), 2 * width(1.0));
  // For a fast input, the friction is dry. While the pressure rises from 0 to 40 kPa, the state of the
  // friction rises from -turn to turn. At 20 kPa, the state is `middle`.
  const double turn = 10 * std::tanh(2.0);
  const double middle = 10 - (10 + turn) * std::exp(-2.0);
  EXPECT_NEAR(width(1e6), 2 * 0.03 * middle, 1e-5);
}

TEST(RelaxingFriction, RelaxesExponentiallyAtConstantPressure) {
  Block block = make<Block>({0.03, 10.0, 1.0});
  double from = 0;
  const double held = move(block, from, 30, 0.1);
  EXPECT_LT(held, -0.1);
  EXPECT_NEAR(move(block, from, 30, 2.0), held * std::exp(-2.0), 1e-12);
}

TEST(RelaxingFriction, StepSizeDoesNotMatter) {
  Block once = make<Block>({0.03, 10.0, 1.0}), often = make<Block>({0.03, 10.0, 1.0});
  double a = 0, b = 0;
  for (const double to : {40.0, 12.0, 33.0, 33.0, 5.0}) {
    const double start = b;
    for (int i = 1; i <= 20; ++i) move(often, b, start + (to - start) * i / 20, 0.05);
    EXPECT_NEAR(move(once, a, to, 1.0), often.output(), 1e-12);
  }
}

}  // namespace
}  // namespace softgrip::model::testing::relaxing_friction_test
