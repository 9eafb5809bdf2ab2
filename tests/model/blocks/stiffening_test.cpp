#include "model/blocks/stiffening.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/model/drive.h"

namespace softgrip::model::testing::stiffening_test {
namespace {

using Block = Stiffening<double>;

TEST(Stiffening, GainDecreasesSymmetricallyWithTheDisplacement) {
  Block block = make<Block>({0.02});
  const auto out = drive(block, 0, std::vector<double>{10, 20, 10, -10}, 0.1);
  EXPECT_NEAR(out[0], 10 / 1.2, 1e-12);
  EXPECT_EQ(out[0], out[2]);
  EXPECT_EQ(out[3], -out[0]);
}

TEST(Stiffening, OutputIsMonotoneAndSmoothForEverySign) {
  for (const double s : {-0.5, -0.02, 0.0, 0.02, 0.5}) {
    Block block = make<Block>({s});
    double last = -1e9;
    for (double y = -40; y <= 40; y += 0.5) {
      const double z = block.peek(0.1, y, {});
      ASSERT_GT(z, last);
      last = z;
    }
  }
  Block above = make<Block>({1e-7}), below = make<Block>({-1e-7});
  EXPECT_NEAR((above.peek(0.1, 10.0, {}) - 10) / 1e-7, -100, 1e-3);
  EXPECT_NEAR((10 - below.peek(0.1, 10.0, {})) / 1e-7, -100, 1e-3);
}

}  // namespace
}  // namespace softgrip::model::testing::stiffening_test
