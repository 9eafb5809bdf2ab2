#include "model/blocks/actuator_threshold.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/model/drive.h"

namespace softgrip::model::testing::actuator_threshold_test {
namespace {

using Block = ActuatorThreshold<double>;

TEST(ActuatorThreshold, HasNoOutputBelowTheThreshold) {
  Block block = make<Block>({5.0});
  EXPECT_EQ(drive(block, 0, std::vector<double>{2, 5, 12, 4, -1, 3}, 0.1),
            (std::vector<double>{0, 0, 7, 0, -1, 0}));
}

TEST(ActuatorThreshold, SplitsTheInputAtEveryCorner) {
  Block block = make<Block>({5.0});
  pass(block, Segment<double>::straight(0.1, 0, -5));
  const auto out = pass(block, Segment<double>::straight(2.0, -5, 15));
  ASSERT_EQ(out.size(), 3u);
  EXPECT_NEAR(out[0].duration_s, 0.5, 1e-12);
  EXPECT_NEAR(out[1].duration_s, 0.5, 1e-12);
  EXPECT_NEAR(out[0].mean, -2.5, 1e-12);
  EXPECT_EQ(out[1].mean, 0);
  EXPECT_NEAR(out[2].mean, 5, 1e-12);
  EXPECT_EQ(out[2].end, 10);
  EXPECT_EQ(pass(block, Segment<double>::straight(2.0, 15, -5)).size(), 3u);
}

}  // namespace
}  // namespace softgrip::model::testing::actuator_threshold_test
