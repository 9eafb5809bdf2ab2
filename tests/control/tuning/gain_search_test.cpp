#include "control/tuning/gain_search.h"

#include <gtest/gtest.h>

#include <cmath>

namespace softgrip::control::gain_search_test {
namespace {

TEST(GainSearch, FindsTheMinimumOfAConvexCost) {
  int evaluations = 0;
  const auto cost = [&](const PidSettings& pid) {
    ++evaluations;
    return std::pow(std::log(pid.kp_kpa_per_mm / 0.37), 2) +
           std::pow(std::log(pid.ki_kpa_per_mm_s / 2.2), 2) + 100 * std::pow(pid.kd_kpa_s_per_mm - 0.015, 2);
  };
  const PidSettings found = search_gains(cost);
  EXPECT_NEAR(found.kp_kpa_per_mm, 0.37, 0.01);
  EXPECT_NEAR(found.ki_kpa_per_mm_s, 2.2, 0.05);
  EXPECT_NEAR(found.kd_kpa_s_per_mm, 0.015, 0.005);
  EXPECT_LT(evaluations, 160);
}

TEST(GainSearch, ACoarseGridHasFewerPointsAndFindsTheMinimum) {
  int evaluations = 0;
  const auto cost = [&](const PidSettings& pid) {
    ++evaluations;
    return std::pow(std::log(pid.kp_kpa_per_mm / 0.37), 2) + std::pow(std::log(pid.ki_kpa_per_mm_s / 2.2), 2);
  };
  GainSearch search;
  search.iterations = 0;
  search.coarseness = 1;
  (void)search_gains(cost, search);
  EXPECT_EQ(evaluations, 30 + 3)
      << "30 points of the grid, and 3 points of the simplex around the best point of the grid";
  evaluations = 0;
  search.coarseness = 5;
  (void)search_gains(cost, search);
  EXPECT_EQ(evaluations, 6 + 3);
  search.iterations = 200;
  EXPECT_NEAR(search_gains(cost, search).kp_kpa_per_mm, 0.37, 0.01);
}

TEST(GainSearch, EndsIfAllSimplexPointsHaveTheSameCost) {
  int evaluations = 0;
  const GainPoint found = nelder_mead(
      [&](const GainPoint&) {
        ++evaluations;
        return 1.0;
      },
      {0, 0, 0}, 1, {.iterations = 1000, .done_share = 1e-3});
  EXPECT_EQ(evaluations, 3) << "the search ends after the first simplex because all points are equally good";
  EXPECT_EQ(found, (GainPoint{0, 0, 0}));
}

TEST(GainSearch, NoGainIsEverNegative) {
  (void)search_gains([](const PidSettings& pid) {
    EXPECT_GE(pid.kp_kpa_per_mm, 0);
    EXPECT_GE(pid.ki_kpa_per_mm_s, 0);
    EXPECT_GE(pid.kd_kpa_s_per_mm, 0);
    return pid.kp_kpa_per_mm + pid.ki_kpa_per_mm_s + pid.kd_kpa_s_per_mm;
  });
}

}  // namespace
}  // namespace softgrip::control::gain_search_test
