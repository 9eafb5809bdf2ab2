#include "model/blocks/sensor_warm_up.h"

#include <gtest/gtest.h>

#include "tests/model/drive.h"

namespace softgrip::model::testing::sensor_warm_up_test {
namespace {

using Block = SensorWarmUp<double>;

TEST(SensorWarmUp, DriftApproachesTheFinalValueExponentially) {
  Block block = make<Block>({0.5, 60.0});
  Surroundings around;
  for (const double time_s : {0.0, 60.0, 3600.0}) {
    around.time_s = time_s;
    EXPECT_NEAR(block.sample(3.0, 0.1, around), 3 - 0.5 * std::expm1(-time_s / 60), 1e-12) << time_s;
  }
}

}  // namespace
}  // namespace softgrip::model::testing::sensor_warm_up_test
