#include "sysid/logs/turning_points.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace softgrip::sysid::turning_points_test {
namespace {

using Indices = std::vector<std::size_t>;
using Values = std::vector<double>;

TEST(TurningPoints, AreWhereASignalGoesBackFarEnough) {
  const Values values{0, 3, 2.6, 5, 1, 1.3, 0.5, 4};
  EXPECT_EQ(turning_points(values, 1), (Indices{0, 3, 6, 7}));
  EXPECT_EQ(turning_points(values, 0.35), (Indices{0, 1, 2, 3, 6, 7}));
  EXPECT_EQ(turning_points(values, 10), (Indices{0, 7}));
}

TEST(TurningPoints, TheFirstWayMayGoDown) {
  EXPECT_EQ(turning_points({5, 5.2, 1, 4}, 1), (Indices{0, 1, 2, 3}));
  EXPECT_EQ(turning_points({5, 4, 1, 4}, 1), (Indices{0, 2, 3}));
}

TEST(TurningPoints, OneValueIsOne) {
  EXPECT_EQ(turning_points({7}, 1), Indices{0});
}

TEST(SteadyBetweenTurns, RisesAndFallsAndKeepsItsTurns) {
  const Values values{0, 3, 2.6, 5, 1, 1.3, 0.5, 4};
  const Values steady = steady_between_turns(values, 1);
  EXPECT_EQ(steady, (Values{0, 2.8, 2.8, 5, 1.15, 1.15, 0.5, 4}));
}

TEST(SteadyBetweenTurns, AHoldIsTheMeanOfWhatWavers) {
  Values values(10, 0.0);
  for (int i = 0; i < 100; ++i) values.push_back(20 + (i % 2 == 0 ? 0.1 : -0.1));
  const Values steady = steady_between_turns(values, 1);
  EXPECT_TRUE(std::is_sorted(steady.begin(), steady.end()));
  EXPECT_NEAR(steady[60], 20, 0.01);
}

TEST(SteadyBetweenTurns, WhatIsSteadyStaysAsItIs) {
  const Values values{4, 2, 2, 1, 3, 8, 9};
  EXPECT_EQ(steady_between_turns(values, 0.5), values);
}

}  // namespace
}  // namespace softgrip::sysid::turning_points_test
