#include "model/blocks/sensor_drift.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/model/drive.h"

namespace softgrip::model::testing {
namespace {

using Block = SensorDrift<double>;

TEST(SensorDrift, WandersWithTheTimeOfTheCampaign) {
  Block block = make<Block>({1.8, 0.5, 60.0, 0.0, 0.0, 300.0, 30.0});
  Surroundings around;
  around.time_s = 0;
  EXPECT_EQ(block.sample(3.0, 0.1, around), 3);
  around.time_s = 3600;
  EXPECT_NEAR(block.sample(3.0, 0.1, around), 5.3, 1e-12);
  around.time_s = 60;
  EXPECT_NEAR(block.sample(3.0, 0.1, around), 3 + 0.03 - 0.5 * std::expm1(-1.0), 1e-12);
}

TEST(SensorDrift, WandersToAndFroFromZero) {
  Block block = make<Block>({0.0, 0.0, 60.0, 0.3, 0.2, 200.0, 30.0});
  Surroundings around;
  for (const auto& [time_s, drift_mm] : std::vector<std::pair<double, double>>{
           {0, 0.0}, {50, 0.3 - 0.2}, {100, -0.4}, {150, -0.3 - 0.2}, {200, 0.0}}) {
    around.time_s = time_s;
    EXPECT_NEAR(block.sample(3.0, 0.1, around), 3 + drift_mm, 1e-12) << time_s;
  }
}

TEST(SensorDrift, GoesStraightFromKnotToKnotAndStays) {
  Block block = make<Block>({0.0, 0.0, 60.0, 0.0, 0.0, 300.0, 20.0, 0.4, -0.2, 0.1});
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
}  // namespace softgrip::model::testing
