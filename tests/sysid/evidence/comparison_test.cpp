#include "sysid/evidence/comparison.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "sysid/limits/limits.h"

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

TEST(Comparison, AFailureInOneBlockIsALossReduction) {
  // The standard error of the mean difference is as large as the mean, because one block determines both.
  const PairedLosses failing{
      .worse = {11, 11, 10, 11, 500}, .better = {10, 10, 10, 10, 10}, .rows = {10, 10, 10, 10, 10}};
  EXPECT_TRUE(is_better(compare(failing, 0, 1)));
  const PairedLosses balanced{
      .worse = {11, 1, 11, 1, 500}, .better = {10, 10, 10, 500, 10}, .rows = {10, 10, 10, 10, 10}};
  EXPECT_FALSE(is_better(compare(balanced, 0, 1))) << "each model fails in one block";
}

TEST(ErrorReduction, IsARatioInEachSample) {
  // The losses differ by a factor of 100 between the blocks, but the ratio is the same in each block.
  const PairedLosses paired{.worse = {4, 400, 40, 4}, .better = {1, 100, 10, 1}, .rows = {10, 10, 10, 10}};
  const ErrorReduction same = error_reduction(paired, 1);
  EXPECT_NEAR(same.share, 0.5, 1e-12);
  EXPECT_NEAR(same.interval.lower, 0.5, 1e-12);
  EXPECT_NEAR(same.interval.upper, 0.5, 1e-12);
  EXPECT_EQ(error_reduction({{0, 0}, {0, 0}, {1, 1}}, 1).share, 0);
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

TEST(Comparison, SquaredResidualsAreSummedInTheirBlock) {
  PairedLosses first, second;
  first.begin_block();
  first.add(3, 1);
  first.add(-4, 2);
  second.begin_block();
  second.begin_block();
  second.add(1, 0);
  first.append(second);
  EXPECT_EQ(first.worse, (std::vector<double>{25, 0, 1}));
  EXPECT_EQ(first.better, (std::vector<double>{5, 0, 0}));
  EXPECT_EQ(first.rows, (std::vector<double>{2, 0, 1}));
}

TEST(Comparison, TheSameSeedGivesTheSameAnswer) {
  const PairedLosses paired = losses(0.2, 1, 12, 3);
  EXPECT_EQ(compare(paired, 0, 7).share, compare(paired, 0, 7).share);
  EXPECT_EQ(compare(paired, 0, 7).lower, compare(paired, 0, 7).lower);
  EXPECT_NE(compare(paired, 0, 7).lower, compare(paired, 0, 8).lower);
}

TEST(Tolerance, FactorDecreasesWithTheNumberOfRuns) {
  EXPECT_NEAR(run_to_run_factor(1), 9.28, 0.01);
  double before = run_to_run_factor(1);
  for (std::size_t runs = 2; runs <= 20; ++runs) {
    EXPECT_LT(run_to_run_factor(runs), before);
    before = run_to_run_factor(runs);
  }
  EXPECT_GT(before, 1);
}

TEST(Tolerance, IsExceededByFivePercentOfSimilarRuns) {
  // Simulates 4,000 sets of runs with seed 1. A run is a point with three coordinates. All coordinates have
  // the same standard deviation.
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0, 1);
  using Run = std::array<double, 3>;
  const auto run = [&] { return Run{normal(random), normal(random), normal(random)}; };
  // Predicts one run as the mean of the other runs, and returns the squared error of the prediction.
  const auto improvement = [](const Run& predicted, const std::vector<Run>& runs, std::size_t left_out) {
    const auto others = static_cast<double>(runs.size() - (left_out < runs.size() ? 1 : 0));
    double sum = 0;
    for (std::size_t d = 0; d < predicted.size(); ++d) {
      double mean = 0;
      for (std::size_t r = 0; r < runs.size(); ++r) mean += r == left_out ? 0 : runs[r][d] / others;
      sum += std::pow(predicted[d] - mean, 2);
    }
    return sum;
  };
  for (const std::size_t count : {2U, 3U, 6U}) {
    int exceeded = 0;
    constexpr int sets = 4000;
    for (int i = 0; i < sets; ++i) {
      std::vector<Run> runs(count);
      std::generate(runs.begin(), runs.end(), run);
      std::vector<NullGains> units(count);
      for (std::size_t r = 0; r < count; ++r) units[r]["ageing"] = improvement(runs[r], runs, r);
      exceeded += improvement(run(), runs, count) > Tolerance(units, count).of("ageing") ? 1 : 0;
    }
    EXPECT_NEAR(exceeded / static_cast<double>(sets), 0.05, 0.012) << count;
  }
}

TEST(Tolerance, CauseWithoutHealthyImprovementUsesTheAverage) {
  const Tolerance tolerance({{{"contact", -0.1}, {"ageing", 0.4}}, {{"contact", 0.0}, {"ageing", 0.2}}}, 2);
  EXPECT_DOUBLE_EQ(tolerance.usual("contact"), 0);
  EXPECT_DOUBLE_EQ(tolerance.usual("ageing"), 0.3);
  EXPECT_DOUBLE_EQ(tolerance.of("contact"), 0.15 * run_to_run_factor(2));
  EXPECT_DOUBLE_EQ(tolerance.of("ageing"), 0.3 * run_to_run_factor(2));
  EXPECT_DOUBLE_EQ(tolerance.of("a cause that was not searched"), 0.15 * run_to_run_factor(2));
}

TEST(Tolerance, GrowsByTheErrorOfAnUnfamiliarInput) {
  const std::vector<NullGains> units{{{"ageing", 0.04}}, {{"ageing", 0.02}}};
  EXPECT_NEAR(Tolerance(units, 2, 0.5).of("ageing"), 0.53 * run_to_run_factor(2), 1e-12);
}

}  // namespace

}  // namespace softgrip::sysid::comparison_test
