#include "model/blocks/thermal_gain.h"

#include <gtest/gtest.h>

#include "tests/model/drive.h"

namespace softgrip::model::testing::thermal_gain_test {
namespace {

using Block = ThermalGain<double>;

TEST(ThermalGain, FollowsTheTemperature) {
  Block block = make<Block>({0.01});
  Surroundings warm;
  warm.temperature_c = 30;
  pass(block, Segment<double>::straight(1.0, 0, 10), warm);
  EXPECT_NEAR(block.output(), 11, 1e-12);
  warm.temperature_c = 10;
  pass(block, Segment<double>::straight(1.0, 10, 10), warm);
  EXPECT_NEAR(block.output(), 9, 1e-12);
  EXPECT_NEAR(block.peek(0.1, 5.0, warm), 4.5, 1e-12);
}

TEST(ThermalGain, NothingHappensAtTwentyDegrees) {
  Block block = make<Block>({0.01});
  pass(block, Segment<double>::straight(1.0, 0, 10));
  EXPECT_EQ(block.output(), 10);
}

}  // namespace
}  // namespace softgrip::model::testing::thermal_gain_test
