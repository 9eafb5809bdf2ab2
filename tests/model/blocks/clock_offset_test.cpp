#include "model/blocks/clock_offset.h"

#include <gtest/gtest.h>

#include "tests/model/drive.h"

namespace softgrip::model::testing::clock_offset_test {
namespace {

TEST(ClockOffset, ALinearMotionIsReadWithTheExactLead) {
  ClockOffset<double> block = make<ClockOffset<double>>({0.12});
  block.reset(3);
  EXPECT_DOUBLE_EQ(block.output(), 3);
  for (int i = 1; i <= 50; ++i) block.sample(3 + 5 * 0.02 * i, 0.02, {});
  EXPECT_NEAR(block.output(), 3 + 5 * (0.02 * 50 + 0.12), 1e-12);
}

// The block uses the slope of its input at the middle of the last step. For a parabola, the error is
// therefore proportional to the step length.
TEST(ClockOffset, ErrorForAParabolaIsProportionalToTheStep) {
  constexpr double lead_s = 0.12;
  for (const double step_s : {0.02, 0.01, 0.005}) {
    ClockOffset<double> block = make<ClockOffset<double>>({lead_s});
    block.reset(0);
    double t = 0;
    for (int i = 1; i <= 200; ++i) {
      t = step_s * i;
      block.sample(t * t, step_s, {});
    }
    EXPECT_NEAR(block.output(), t * t + lead_s * (2 * t - step_s), 1e-12) << step_s;
  }
}

}  // namespace
}  // namespace softgrip::model::testing::clock_offset_test
