#include "model/blocks/periodic_disturbance.h"

#include <gtest/gtest.h>

#include "tests/model/drive.h"

namespace softgrip::model::testing::periodic_disturbance_test {
namespace {

using Block = PeriodicDisturbance<double>;

TEST(PeriodicDisturbance, OscillatesWithTheRecordingTime) {
  Block block = make<Block>({0.3, 0.4, 2.0});
  Surroundings around;
  around.time_s = 0;
  EXPECT_NEAR(block.sample(1.0, 0.1, around), 1.4, 1e-12);
  around.time_s = 0.125;
  EXPECT_NEAR(block.sample(1.0, 0.1, around), 1.3, 1e-12);
  around.time_s = 100.25;
  EXPECT_NEAR(block.sample(1.0, 0.1, around), 0.6, 1e-9);
}

}  // namespace
}  // namespace softgrip::model::testing::periodic_disturbance_test
