#include "sysid/evidence/tolerance.h"
#include "sysid/limits/limits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace softgrip::sysid::tolerance_test {
namespace {

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
}  // namespace softgrip::sysid::tolerance_test
