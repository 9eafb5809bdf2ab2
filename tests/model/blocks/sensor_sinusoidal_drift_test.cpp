#include "model/blocks/sensor_sinusoidal_drift.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/model/drive.h"

namespace softgrip::model::testing::sensor_sinusoidal_drift_test {
namespace {

using Block = SensorSinusoidalDrift<double>;

TEST(SensorSinusoidalDrift, DriftIsTheSumOfTwoSinusoids) {
  Block block = make<Block>({0.3, 0.2, 200.0});
  Surroundings around;
  for (const auto& [time_s, drift_mm] : std::vector<std::pair<double, double>>{
           {0, 0.0}, {50, 0.3 - 0.2}, {100, -0.4}, {150, -0.3 - 0.2}, {200, 0.0}}) {
    around.time_s = time_s;
    EXPECT_NEAR(block.sample(3.0, 0.1, around), 3 + drift_mm, 1e-12) << time_s;
  }
}

}  // namespace
}  // namespace softgrip::model::testing::sensor_sinusoidal_drift_test
