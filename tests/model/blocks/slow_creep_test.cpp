#include "model/blocks/slow_creep.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/model/drive.h"

namespace softgrip::model::testing::slow_creep_test {
namespace {

using Block = SlowCreep<double>;

TEST(SlowCreep, CreepsExponentiallyAtConstantPressure) {
  Block block = make<Block>({0.05, 60.0});
  double from = 0;
  move(block, from, 30, 0);
  EXPECT_EQ(block.output(), 0);
  move(block, from, 30, 90);
  EXPECT_NEAR(block.output(), -30 * 0.05 * std::expm1(-90 / 60.0), 1e-12);
  block.reset(30.0);
  EXPECT_NEAR(block.output(), 1.5, 1e-12);
}

TEST(SlowCreep, RampResponseIsIndependentOfTheStepSize) {
  Block once = make<Block>({0.05, 60.0}), often = make<Block>({0.05, 60.0});
  double a = 0, b = 0;
  for (int i = 1; i <= 500; ++i) move(often, b, 0.1 * i, 0.2);
  EXPECT_NEAR(move(once, a, 50, 100), often.output(), 1e-12);
}

}  // namespace
}  // namespace softgrip::model::testing::slow_creep_test
