#include "model/port_flow.h"

#include <gtest/gtest.h>

namespace softgrip::model::port_flow_test {
namespace {

TEST(PortFlow, IsChokedAtLowRatiosAndZeroAtEqualPressures) {
  EXPECT_DOUBLE_EQ(port_flow(700.0, atmosphere_kpa), 700.0);
  EXPECT_DOUBLE_EQ(port_flow(700.0, 0.3 * 700.0), 700.0);
  EXPECT_DOUBLE_EQ(port_flow(150.0, 150.0), 0.0);
}

// ISO 6358-1: with the critical ratio b, the flow is C p1 sqrt(1 - ((p2/p1 - b) / (1 - b))^2).
TEST(PortFlow, AgreesWithTheStandardBetweenTheLimits) {
  EXPECT_NEAR(port_flow(200.0, 130.0), 200 * 0.8660254037844386, 1e-9);  // the quotient is 0.5
}

// ISO 6358-1 permits a linear flow above the ratio 0.995.
TEST(PortFlow, IsLinearInTheRatioNearEqualPressures) {
  const double at_limit = 200 * std::sqrt(1 - (0.695 / 0.7) * (0.695 / 0.7));
  EXPECT_NEAR(port_flow(200.0, 0.995 * 200), at_limit, 1e-9);
  EXPECT_NEAR(port_flow(200.0, 0.9975 * 200), at_limit / 2, 1e-9);
}

TEST(PortFlow, IsContinuousAndFallsWithTheRatio) {
  double last = port_flow(200.0, 0.2 * 200.0);
  int steps = 0;
  for (double ratio = 0.2005; ratio < 1; ratio += 0.0005, ++steps) {
    const double flow = port_flow(200.0, ratio * 200.0);
    EXPECT_LE(flow, last) << ratio;
    EXPECT_LT(last - flow, 200 * 0.012) << ratio;  // steepest in the linear part: 0.119 / 0.005 per ratio
    last = flow;
  }
  EXPECT_GT(steps, 1500);
}

}  // namespace
}  // namespace softgrip::model::port_flow_test
