#include "model/blocks/outliers.h"

#include <gtest/gtest.h>

#include "tests/model/drive.h"

namespace softgrip::model::testing::outliers_test {
namespace {

using Block = Outliers<double>;

TEST(Outliers, OccurWithTheGivenProbabilityInBothDirections) {
  Block block = make<Block>({0.05, 2.0});
  int up = 0, down = 0;
  for (int i = 0; i < 20000; ++i) {
    const double y = block.sample(1.0, 0.01, {});
    up += y == 3.0;
    down += y == -1.0;
    ASSERT_TRUE(y == 1.0 || y == 3.0 || y == -1.0);
  }
  EXPECT_NEAR(up, 500, 110);  // the tolerance is 5 standard deviations of the count
  EXPECT_NEAR(down, 500, 110);
}

TEST(Outliers, EqualSeedsGiveEqualOutliers) {
  Block a = make<Block>({0.5, 2.0}), b = make<Block>({0.5, 2.0});
  for (int i = 0; i < 100; ++i) ASSERT_EQ(a.sample(0.0, 0.01, {}), b.sample(0.0, 0.01, {}));
}

}  // namespace
}  // namespace softgrip::model::testing::outliers_test
