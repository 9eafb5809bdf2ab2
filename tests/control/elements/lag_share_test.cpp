#include "control/elements/lag_share.h"

#include <gtest/gtest.h>

namespace softgrip::control::lag_share_test {
namespace {

TEST(LagShare, SuccessiveStepsEqualOneLongStep) {
  double left = 1;
  for (int k = 0; k < 20; ++k) left *= 1 - lag_share(0.005, 0.044);
  EXPECT_NEAR(1 - left, lag_share(0.1, 0.044), 1e-14);
  EXPECT_NEAR(lag_share(0.044, 0.044), 1 - std::exp(-1.0), 1e-15);
}

TEST(LagShare, IsOneWithoutATimeConstant) {
  EXPECT_EQ(lag_share(0.005, 0), 1);
}

}  // namespace
}  // namespace softgrip::control::lag_share_test
