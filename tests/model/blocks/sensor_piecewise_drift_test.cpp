#include "model/blocks/sensor_piecewise_drift.h"

#include <gtest/gtest.h>

#include "tests/model/drive.h"

namespace softgrip::model::testing::sensor_piecewise_drift_test {
namespace {

using Block = SensorPiecewiseDrift<double>;

TEST(SensorPiecewiseDrift, IsLinearBetweenKnotsAndConstantAfterTheLast) {
  Block block = make<Block>({20.0, 0.4, -0.2, 0.1});
  Surroundings around;
  for (const auto& [time_s, drift_mm] : std::vector<std::pair<double, double>>{{0, 0.0},
                                                                               {5, 0.1},
                                                                               {20, 0.4},
                                                                               {30, 0.1},
                                                                               {40, -0.2},
                                                                               {50, -0.05},
                                                                               {60, 0.1},
                                                                               {61, 0.1},
                                                                               {1e9, 0.1}}) {
    around.time_s = time_s;
    EXPECT_NEAR(block.sample(3.0, 0.1, around), 3 + drift_mm, 1e-12) << time_s;
  }
}

}  // namespace
}  // namespace softgrip::model::testing::sensor_piecewise_drift_test
