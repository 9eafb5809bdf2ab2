#include "model/blocks/crescent_hysteresis.h"

#include <gtest/gtest.h>

#include "tests/model/drive.h"

namespace softgrip::model::testing::crescent_hysteresis_test {
namespace {

using Block = CrescentHysteresis<double>;

/// Returns half the displacement [mm] between the loading envelope and the unloading envelope at one
/// pressure.
double half_width(double gain, double bend, double range, double p) {
  const double x = p / range;
  return 0.5 * gain * range * (x - x / (1 + bend * (1 - x)));
}

TEST(CrescentHysteresis, FollowsTheLoadingAndTheUnloadingEnvelope) {
  Block block = make<Block>({0.05, 3.0, 50.0});
  double from = 0;
  EXPECT_NEAR(move(block, from, 30, 1), -half_width(0.05, 3, 50, 30), 1e-12);
  EXPECT_NEAR(move(block, from, 50, 1), 0, 1e-12);
  EXPECT_NEAR(move(block, from, 20, 1), half_width(0.05, 3, 50, 20), 1e-12);
  EXPECT_NEAR(move(block, from, 0, 1), 0, 1e-12);
}

TEST(CrescentHysteresis, HasTheMeanSlopeBetweenTheEnvelopes) {
  Block block = make<Block>({0.05, 3.0, 50.0});
  double from = 0;
  const double at_30 = move(block, from, 30, 1), at_28 = move(block, from, 28, 1);
  // Between the two envelopes, the slope of the displacement over the pressure is the mean of the slopes of
  // the two envelopes.
  const auto middle = [](double p) { return p / 50 - half_width(1, 3, 50, p) / 50; };
  EXPECT_NEAR(at_28 - at_30, 0.05 * 50 * (middle(30) - middle(28)), 1e-12);
  EXPECT_NEAR(move(block, from, 30, 1), at_30, 1e-12);
}

TEST(CrescentHysteresis, AddsNothingOutsideItsRange) {
  Block block = make<Block>({0.05, 3.0, 50.0});
  double from = 0;
  EXPECT_NEAR(move(block, from, 70, 1), 0, 1e-12);
  EXPECT_NEAR(move(block, from, 55, 1), 0, 1e-12);
  EXPECT_NEAR(move(block, from, -10, 1), 0, 1e-12);
}

TEST(CrescentHysteresis, OutputIsIndependentOfRateAndStepSize) {
  Block once = make<Block>({0.05, 3.0, 50.0}), often = make<Block>({0.05, 3.0, 50.0});
  double a = 0, b = 0;
  for (const double to : {40.0, 12.0, 33.0, 5.0, 60.0, 0.0}) {
    const double start = b;
    for (int i = 1; i <= 20; ++i) move(often, b, start + (to - start) * i / 20, 7.0);
    EXPECT_NEAR(move(once, a, to, 0.01), often.output(), 1e-12);
  }
}

}  // namespace
}  // namespace softgrip::model::testing::crescent_hysteresis_test
