#include "model/blocks/sensor_saturation.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/model/drive.h"

namespace softgrip::model::testing::sensor_saturation_test {
namespace {

using Block = SensorSaturation<double>;

TEST(SensorSaturation, ClipsReadingsAtBothLimits) {
  Block block = make<Block>({-1.0, 20.0});
  EXPECT_EQ(block.sample(-3.0, 0.1, {}), -1);
  EXPECT_EQ(block.sample(7.0, 0.1, {}), 7);
  EXPECT_EQ(block.sample(21.0, 0.1, {}), 20);
  EXPECT_FALSE(Block::objection(std::vector<double>{3, 3}).empty());
}

}  // namespace
}  // namespace softgrip::model::testing::sensor_saturation_test
