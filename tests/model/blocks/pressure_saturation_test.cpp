#include "model/blocks/pressure_saturation.h"

#include <gtest/gtest.h>

#include "tests/model/drive.h"

namespace softgrip::model::testing::pressure_saturation_test {
namespace {

using Block = PressureSaturation<double>;

TEST(PressureSaturation, SplitsASegmentAtTheLimit) {
  Block block = make<Block>({30.0});
  const auto up = pass(block, Segment<double>::straight(1.0, 10, 50));
  ASSERT_EQ(up.size(), 2u);
  EXPECT_NEAR(up[0].duration_s, 0.5, 1e-15);
  EXPECT_EQ(up[0].end, 30);
  EXPECT_EQ(up[1].begin, 30);
  EXPECT_EQ(up[1].mean, 30);
  EXPECT_NEAR(up[1].duration_s, 0.5, 1e-15);
  const auto down = pass(block, Segment<double>::straight(1.0, 50, 0));
  ASSERT_EQ(down.size(), 2u);
  EXPECT_NEAR(down[0].duration_s, 0.4, 1e-15);
  EXPECT_EQ(down[1].begin, 30);
  EXPECT_NEAR(down[1].mean, 15, 1e-12);
}

TEST(PressureSaturation, DoesNotSplitASegmentThatOnlyReachesTheLimit) {
  Block block = make<Block>({30.0});
  EXPECT_EQ(pass(block, Segment<double>::straight(1.0, 10, 30)).size(), 1u);
  const auto above = pass(block, Segment<double>::straight(1.0, 30, 40));
  ASSERT_EQ(above.size(), 1u);
  EXPECT_EQ(above[0].end, 30);
  EXPECT_EQ(pass(block, Segment<double>::straight(0.0, 40, 5)).size(), 2u);
  EXPECT_EQ(block.output(), 5);
}

TEST(PressureSaturation, SplitsACurvedSegmentAtTheLimit) {
  Block block = make<Block>({30.0});
  const Segment<double> curved{1.0, 10, 50, 35};
  const auto out = pass(block, curved);
  ASSERT_EQ(out.size(), 2u);
  EXPECT_NEAR(curved.at(out[0].duration_s), 30, 1e-12);
}

}  // namespace
}  // namespace softgrip::model::testing::pressure_saturation_test
