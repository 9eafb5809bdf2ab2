#include "model/blocks/clock_offset.h"

#include <gtest/gtest.h>

#include "tests/model/drive.h"

namespace softgrip::model::testing::clock_offset_test {
namespace {

TEST(ClockOffset, AStraightMotionIsReadAheadOfTime) {
  ClockOffset<double> block = make<ClockOffset<double>>({0.12});
  block.reset(3);
  EXPECT_DOUBLE_EQ(block.output(), 3);
  for (int i = 1; i <= 50; ++i) block.sample(3 + 5 * 0.02 * i, 0.02, {});
  EXPECT_NEAR(block.output(), 3 + 5 * (0.02 * 50 + 0.12), 1e-12);
}

}  // namespace
}  // namespace softgrip::model::testing::clock_offset_test
