#include "base/statistics.h"

#include <array>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace softgrip::statistics_test {
namespace {

TEST(Median, IsTheUpperOfTwoMiddleValues) {
  std::vector<double> odd{5, 1, 9}, even{4, 1, 3, 2}, none;
  EXPECT_EQ(median_of(std::span(odd)), 5);
  EXPECT_EQ(median_of(std::span(even)), 3);
  EXPECT_EQ(median_of(std::span(none)), 0);
  std::array<int, 4> part{7, 8, 9, -1};
  EXPECT_EQ(median_of(std::span(part).first(3)), 8);
}

TEST(Moments, ComputeTheMeanAndTheStandardDeviationBesideALargeOffset) {
  Moments moments;
  EXPECT_EQ(moments.deviation(), 0);
  moments.add(1e9 + 4);
  EXPECT_EQ(moments.deviation(), 0);
  for (const double x : {7.0, 13.0, 16.0}) moments.add(1e9 + x);
  EXPECT_EQ(moments.count, 4U);
  EXPECT_DOUBLE_EQ(moments.mean, 1e9 + 10);
  EXPECT_NEAR(moments.deviation(), std::sqrt(30.0), 1e-9);  // (36 + 9 + 9 + 36) / 3
}

TEST(PairSums, ComputeTheSlopeAndSkipNaN) {
  PairSums sums, still;
  for (const double x : {1.0, 2.0, 4.0}) {
    sums.add(x, 3 - 2 * x);
    still.add(5, x);
  }
  sums.add(std::nan(""), 100);
  sums.add(100, std::nan(""));
  EXPECT_EQ(sums.count, 3);
  EXPECT_NEAR(sums.slope(), -2, 1e-12);
  EXPECT_NEAR(sums.correlation(), -1, 1e-12);
  EXPECT_EQ(still.variance_x(), 0);
  EXPECT_EQ(still.correlation(), 0);
}

TEST(ThirdDifferenceNoise, EstimatesTheNoiseWithoutTheTrend) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0, 0.2);
  std::vector<double> course, noisy;
  for (int i = 0; i < 4000; ++i) {
    course.push_back(3 * std::sin(0.01 * i) + (i > 2000 ? 50 : 0));
    noisy.push_back(course.back() + normal(random));
  }
  EXPECT_LT(third_difference_noise(course), 1e-5);
  EXPECT_NEAR(third_difference_noise(noisy), 0.2, 0.02);
  EXPECT_EQ(third_difference_noise(std::span(noisy).first(3)), 0);
}

TEST(TQuantile, AgreesWithTheTableOfAbramowitzAndStegun) {
  // The expected values are from Abramowitz and Stegun, table 26.10, for the probability 0.975.
  const std::vector<std::pair<double, double>> table{{1, 12.706},  {2, 4.303},  {3, 3.182},  {4, 2.776},
                                                     {5, 2.571},   {10, 2.228}, {30, 2.042}, {60, 2.000},
                                                     {120, 1.980}, {1e9, 1.960}};
  for (const auto& [degrees, quantile] : table) EXPECT_NEAR(t_quantile(degrees), quantile, 5e-4) << degrees;
}

TEST(TQuantile, TreatsFewerThanOneDegreeOfFreedomAsOne) {
  for (const double degrees : {0.5, 0.0, -3.0}) EXPECT_EQ(t_quantile(degrees), t_quantile(1)) << degrees;
}

TEST(FQuantile, AgreesWithTheTablesOfAbramowitzAndStegun) {
  // The expected values are from Abramowitz and Stegun, table 26.9. The last value is an upper 1 % quantile,
  // and the other values are upper 5 % quantiles.
  EXPECT_NEAR(f_quantile(0.95, 1, 1), 161.4, 0.1);
  EXPECT_NEAR(f_quantile(0.95, 3, 3), 9.28, 0.005);
  EXPECT_NEAR(f_quantile(0.95, 3, 9), 3.86, 0.005);
  EXPECT_NEAR(f_quantile(0.95, 10, 20), 2.35, 0.005);
  EXPECT_NEAR(f_quantile(0.99, 5, 10), 5.64, 0.005);
}

TEST(ChiSquareQuantile, MatchesTheTables) {
  // The expected values are from Abramowitz and Stegun, table 26.8, for the probabilities 0.95 and 0.999.
  EXPECT_NEAR(chi_square_quantile(1.645, 1), 3.841, 0.04 * 3.841);
  EXPECT_NEAR(chi_square_quantile(3.090, 1), 10.828, 0.04 * 10.828);
  EXPECT_NEAR(chi_square_quantile(1.645, 4), 9.488, 0.04 * 9.488);
  EXPECT_NEAR(chi_square_quantile(3.090, 4), 18.467, 0.04 * 18.467);
  EXPECT_NEAR(chi_square_quantile(3.090, 10), 29.588, 0.04 * 29.588);
}

TEST(FQuantile, SwappedDegreesOfFreedomGiveTheReciprocal) {
  for (const double p : {0.05, 0.3, 0.5, 0.9, 0.99})
    EXPECT_NEAR(f_quantile(p, 3, 7) * f_quantile(1 - p, 7, 3), 1, 1e-9) << p;
}

}  // namespace
}  // namespace softgrip::statistics_test
