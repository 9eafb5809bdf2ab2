#include "model/blocks/running_in.h"

#include <gtest/gtest.h>

#include "tests/model/drive.h"

namespace softgrip::model::testing::running_in_test {
namespace {

using Block = RunningIn<double>;

TEST(RunningIn, GainApproachesItsFinalValueExponentially) {
  Block block = make<Block>({0.2, 100.0});
  Surroundings around;
  for (const double time_s : {0.0, 50.0, 100.0, 1e4}) {
    around.time_s = time_s;
    pass(block, Segment<double>::straight(1.0, 10, 10), around);
    EXPECT_NEAR(block.output(), 10 * (1 - 0.2 * std::expm1(-time_s / 100)), 1e-12) << time_s;
  }
}

}  // namespace
}  // namespace softgrip::model::testing::running_in_test
