#include "model/blocks/sensor_lag.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/model/drive.h"

namespace softgrip::model::testing::sensor_lag_test {
namespace {

using Block = SensorLag<double>;

TEST(SensorLag, StepAndRampResponsesMatchTheAnalyticalSolution) {
  Block step = make<Block>({0.05});
  pass(step, Segment<double>::straight(0, 0, 8));
  pass(step, Segment<double>::straight(0.07, 8, 8));
  EXPECT_NEAR(step.output(), -8 * std::expm1(-0.07 / 0.05), 1e-13);
  Block ramp = make<Block>({0.05});
  pass(ramp, Segment<double>::straight(0.3, 0, 3));
  EXPECT_NEAR(ramp.output(), 10 * (0.3 + 0.05 * std::expm1(-6.0)), 1e-12);
}

TEST(SensorLag, MeanSatisfiesTheBalanceOfTheLag) {
  Block block = make<Block>({0.05});
  const auto out = pass(block, Segment<double>{0.1, 0, 10, 6});
  EXPECT_NEAR(0.05 * block.output(), 0.1 * (6 - out[0].mean), 1e-14);
}

}  // namespace
}  // namespace softgrip::model::testing::sensor_lag_test
