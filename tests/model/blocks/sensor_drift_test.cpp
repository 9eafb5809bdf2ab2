#include "model/blocks/sensor_drift.h"

#include <gtest/gtest.h>

#include "tests/model/drive.h"

namespace softgrip::model::testing::sensor_drift_test {
namespace {

using Block = SensorDrift<double>;

TEST(SensorDrift, IncreasesLinearlyWithTime) {
  Block block = make<Block>({1.8});
  Surroundings around;
  for (const double time_s : {0.0, 60.0, 3600.0}) {
    around.time_s = time_s;
    EXPECT_NEAR(block.sample(3.0, 0.1, around), 3 + 1.8 * time_s / 3600, 1e-12) << time_s;
  }
}

}  // namespace
}  // namespace softgrip::model::testing::sensor_drift_test
