#include "model/blocks/leak.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "tests/model/drive.h"

namespace softgrip::model::testing::leak_test {
namespace {

using Block = Leak<double>;

/// Returns the flow of ISO 6358-1 at reference conditions, divided by the conductance. The arguments are
/// absolute pressures. The critical pressure ratio is 0.5.
double flow(double from_kpa, double to_kpa) {
  const double ratio = std::max(to_kpa / from_kpa, 0.5);
  return from_kpa * std::sqrt(1 - std::pow((ratio - 0.5) / 0.5, 2));
}

/// Returns the gauge pressure at the finger at which inflow and outflow are equal. Finds this pressure by
/// bisection.
double balanced_kpa(double before_kpa, double conductance_ratio) {
  double low = 0, high = before_kpa;
  for (int i = 0; i < 100; ++i) {
    const double p = 0.5 * (low + high), at = p + atmosphere_kpa;
    const bool more_comes =
        flow(before_kpa + atmosphere_kpa, at) > conductance_ratio * flow(at, atmosphere_kpa);
    (more_comes ? low : high) = p;
  }
  return low;
}

TEST(Leak, PressureLossAgreesWithTwoRestrictionsInSeries) {
  for (const double ratio : {0.05, 0.1, 0.2}) {
    const LineLoss<double> loss{ratio * ratio};
    for (const double before : {5.0, 20.0, 60.0, 100.0, 150.0, 300.0}) {
      const double lost = before - balanced_kpa(before, ratio);
      EXPECT_NEAR(before - loss.behind(before), lost, 0.03 * lost) << ratio << " " << before;
    }
  }
}

TEST(Leak, IsMonotoneAndExactlyInvertible) {
  for (const double share : {0.0, 0.001, 0.03, 0.5, 10.0}) {
    const LineLoss<double> loss{share};
    double last = loss.behind(-51.0);
    for (double before = -50; before < 400; before += 0.7) {
      const double behind = loss.behind(before);
      EXPECT_GT(behind, last) << share << " " << before;
      EXPECT_NEAR(loss.before(behind), before, 1e-11) << share;
      last = behind;
    }
  }
}

TEST(Leak, IsContinuousAtTheOnsetOfChokedFlow) {
  const LineLoss<double> loss{0.1};
  EXPECT_NEAR(loss.before(atmosphere_kpa * (1 - 1e-12)), loss.before(atmosphere_kpa * (1 + 1e-12)), 1e-9);
}

TEST(Leak, LossIsIndependentOfThePressureHistory) {
  Block block = make<Block>({0.05});
  const std::vector<double> ways = drive(block, 0, std::array{40.0, 60.0, 40.0}, 0.1);
  EXPECT_NEAR(ways[0], LineLoss<double>{0.05}.behind(40.0), 1e-12);
  EXPECT_NEAR(ways[2], ways[0], 1e-12);
  block.reset(40);
  EXPECT_NEAR(block.output(), ways[0], 1e-12);
}

}  // namespace
}  // namespace softgrip::model::testing::leak_test
