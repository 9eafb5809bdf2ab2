#include "model/blocks/sensor_drift.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/model/drive.h"

namespace softgrip::model::testing {
namespace {

using Block = SensorDrift<double>;

TEST(SensorDrift, WandersWithTheTimeOfTheCampaign) {
  Block block = make<Block>({1.8, 0.5, 60.0});
  Surroundings around;
  around.time_s = 0;
  EXPECT_EQ(block.sample(3.0, 0.1, around), 3);
  around.time_s = 3600;
  EXPECT_NEAR(block.sample(3.0, 0.1, around), 5.3, 1e-12);
  around.time_s = 60;
  EXPECT_NEAR(block.sample(3.0, 0.1, around), 3 + 0.03 - 0.5 * std::expm1(-1.0), 1e-12);
}

}  // namespace
}  // namespace softgrip::model::testing
