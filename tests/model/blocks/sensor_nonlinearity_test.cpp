#include "model/blocks/sensor_nonlinearity.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/model/drive.h"

namespace softgrip::model::testing::sensor_nonlinearity_test {
namespace {

using Block = SensorNonlinearity<double>;

TEST(SensorNonlinearity, ErrorIsZeroAtBothEndsAndHasTheGivenAmplitude) {
  Block bow = make<Block>({0.3, 0.0, 30.0});
  EXPECT_NEAR(bow.sample(0.0, 0.1, {}), 0, 1e-15);
  EXPECT_NEAR(bow.sample(15.0, 0.1, {}), 15.3, 1e-12);
  EXPECT_NEAR(bow.sample(30.0, 0.1, {}), 30, 1e-12);
  Block wave = make<Block>({0.0, 0.3, 30.0});
  EXPECT_NEAR(wave.sample(15.0, 0.1, {}), 15, 1e-12);
  double largest = 0;
  for (double y = 0; y <= 30; y += 0.01) largest = std::fmax(largest, wave.sample(y, 0.1, {}) - y);
  EXPECT_NEAR(largest, 0.3, 1e-6);
}

TEST(SensorNonlinearity, ContinuesLinearlyOutsideTheRange) {
  Block block = make<Block>({0.3, 0.2, 30.0});
  for (const double end : {0.0, 30.0}) {
    const double h = 1e-6;
    const double below = block.sample(end, 0.1, {}) - block.sample(end - h, 0.1, {});
    const double above = block.sample(end + h, 0.1, {}) - block.sample(end, 0.1, {});
    EXPECT_NEAR(below, above, 1e-12);
  }
}

}  // namespace
}  // namespace softgrip::model::testing::sensor_nonlinearity_test
