#include "model/blocks/duhem_hysteresis.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/model/drive.h"

namespace softgrip::model::testing::duhem_hysteresis_test {
namespace {

using Block = DuhemHysteresis<double>;

TEST(DuhemHysteresis, HasNoEffectDuringFirstLoading) {
  Block block = make<Block>({0.05, 15.0, 5.0});
  double from = 0;
  EXPECT_EQ(move(block, from, 40, 1), 0);
}

TEST(DuhemHysteresis, UnloadingBuildsTheStateAndLoadingDecaysTheState) {
  Block block = make<Block>({0.05, 15.0, 5.0});
  double from = 0;
  move(block, from, 40, 1);
  const double wound = -15 * 0.05 * std::expm1(-30 / 15.0);
  EXPECT_NEAR(move(block, from, 10, 1), wound, 1e-12);
  EXPECT_NEAR(move(block, from, 25, 1), wound * std::exp(-3.0), 1e-12);
}

TEST(DuhemHysteresis, OutputIsIndependentOfRateAndStepSize) {
  Block once = make<Block>({0.05, 15.0, 5.0}), often = make<Block>({0.05, 15.0, 5.0});
  double a = 0, b = 0;
  for (const double to : {40.0, 12.0, 33.0, 5.0, 60.0, 0.0}) {
    const double start = b;
    for (int i = 1; i <= 20; ++i) move(often, b, start + (to - start) * i / 20, 7.0);
    EXPECT_NEAR(move(once, a, to, 0.01), often.output(), 1e-12);
  }
}

// Returns a measure of the asymmetry of a settled loop between 10 and 50 kPa. For a loop with point symmetry,
// the measure is 0.
double asymmetry(double unloading_kpa, double loading_kpa) {
  Block block = make<Block>({0.05, unloading_kpa, loading_kpa});
  double from = 0;
  for (int i = 0; i < 20; ++i) {
    move(block, from, 50, 1);
    move(block, from, 10, 1);
  }
  const double low = block.output();
  const double up = move(block, from, 20, 1) - low;
  move(block, from, 50, 1);
  const double high = block.output();
  const double down = high - move(block, from, 40, 1);
  return std::fabs(up - down);
}

TEST(DuhemHysteresis, LoopIsPointSymmetricOnlyForEqualLengths) {
  EXPECT_GT(asymmetry(15, 5), 0.05);
  EXPECT_GT(asymmetry(5, 15), 0.05);
  EXPECT_LT(asymmetry(10, 10), 1e-12);
}

}  // namespace
}  // namespace softgrip::model::testing::duhem_hysteresis_test
