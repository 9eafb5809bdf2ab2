#include "sysid/evidence/tolerance.h"

#include <gtest/gtest.h>

#include <random>

#include "sysid/evidence/limits.h"

namespace softgrip::sysid::tolerance_test {
namespace {

TEST(Tolerance, OfOneRunIsThreeTimesInRootMeanSquareAndFallsWithMoreRuns) {
  EXPECT_NEAR(run_to_run_factor(1), 9.28, 0.01);
  double before = run_to_run_factor(1);
  for (std::size_t runs = 2; runs <= 20; ++runs) {
    EXPECT_LT(run_to_run_factor(runs), before);
    before = run_to_run_factor(runs);
  }
  EXPECT_GT(before, 1);
}

TEST(Tolerance, AnotherRunOfTheSameKindExceedsItInOneOfTwenty) {
  // Runs that differ in three directions by the same spread: 3,000 sets of runs, seed 1.
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0, 1);
  const auto improvement = [&] {
    double sum = 0;
    for (int d = 0; d < 3; ++d) sum += std::pow(normal(random), 2);
    return sum;
  };
  for (const std::size_t runs : {1U, 3U, 6U}) {
    int exceeded = 0;
    constexpr int sets = 3000;
    for (int i = 0; i < sets; ++i) {
      std::vector<NullGains> units(runs);
      for (NullGains& unit : units) unit["ageing"] = improvement();
      exceeded += improvement() > Tolerance(units, runs).of("ageing") ? 1 : 0;
    }
    EXPECT_NEAR(exceeded / static_cast<double>(sets), 0.05, 0.012) << runs;
  }
}

TEST(Tolerance, ACauseThatImprovesNothingHealthyIsComparedWithTheAverageCause) {
  const Tolerance tolerance({{{"contact", -0.1}, {"ageing", 0.4}}, {{"contact", 0.0}, {"ageing", 0.2}}}, 2);
  EXPECT_DOUBLE_EQ(tolerance.usual("contact"), 0);
  EXPECT_DOUBLE_EQ(tolerance.usual("ageing"), 0.3);
  EXPECT_DOUBLE_EQ(tolerance.of("contact"), 0.15 * run_to_run_factor(2));
  EXPECT_DOUBLE_EQ(tolerance.of("ageing"), 0.3 * run_to_run_factor(2));
  EXPECT_DOUBLE_EQ(tolerance.of("a cause that was not searched"), 0.15 * run_to_run_factor(2));
}

}  // namespace
}  // namespace softgrip::sysid::tolerance_test
