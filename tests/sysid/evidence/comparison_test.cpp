#include "sysid/evidence/comparison.h"

#include <gtest/gtest.h>

#include <random>

namespace softgrip::sysid::comparison_test {
namespace {

/// Returns the losses of two models in blocks of ten rows. The loss difference per row has the mean `mean`
/// and the standard deviation `spread` between blocks.
PairedLosses losses(double mean, double spread, std::size_t blocks, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(mean, spread);
  PairedLosses paired;
  for (std::size_t b = 0; b < blocks; ++b) {
    paired.rows.push_back(10);
    paired.better.push_back(10);
    paired.worse.push_back(10 + 10 * normal(random));
  }
  return paired;
}

TEST(Comparison, OnlyAClearLossReductionIsBetter) {
  EXPECT_TRUE(is_better(compare(losses(1, 0.1, 20, 1), 0, 1)));
  EXPECT_FALSE(is_better(compare(losses(0, 1, 20, 1), 0, 1)));
  EXPECT_FALSE(is_better(compare(losses(-1, 0.1, 20, 1), 0, 1)));
}

TEST(Comparison, EqualLossesGiveAShareOfZero) {
  EXPECT_DOUBLE_EQ(compare(losses(0, 0, 20, 1), 0, 1).share, 0);
}

TEST(Comparison, TheDifferenceMustExceedTheTolerance) {
  EXPECT_TRUE(is_better(compare(losses(1, 0.1, 20, 1), 0.8, 1)));
  EXPECT_FALSE(is_better(compare(losses(1, 0.1, 20, 1), 1.2, 1)));
}

TEST(Comparison, IntervalCoversTheMeanIn95PercentOfSets) {
  int contained = 0;
  constexpr int sets = 400;
  for (unsigned seed = 1; seed <= sets; ++seed) {
    const Comparison c = compare(losses(0.5, 1, 40, seed), 0, seed);
    contained += c.lower < 0.5 && 0.5 < c.upper ? 1 : 0;
  }
  EXPECT_NEAR(contained / static_cast<double>(sets), 0.95, 0.035);
}

TEST(Comparison, BlocksAreWeightedByNumberOfRows) {
  PairedLosses paired{{0, 100}, {1, 0}, {1000, 10}};
  EXPECT_LT(compare(paired, 0, 1).lower, 0.2);
}

TEST(Comparison, TheSameSeedGivesTheSameAnswer) {
  const PairedLosses paired = losses(0.2, 1, 12, 3);
  EXPECT_EQ(compare(paired, 0, 7).share, compare(paired, 0, 7).share);
  EXPECT_EQ(compare(paired, 0, 7).lower, compare(paired, 0, 7).lower);
  EXPECT_NE(compare(paired, 0, 7).lower, compare(paired, 0, 8).lower);
}

}  // namespace
}  // namespace softgrip::sysid::comparison_test
