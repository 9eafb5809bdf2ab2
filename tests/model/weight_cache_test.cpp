#include "model/weight_cache.h"

#include <gtest/gtest.h>

#include <set>

namespace softgrip::model::weight_cache_test {
namespace {

TEST(RecentDurations, AStoredDurationKeepsItsSlot) {
  RecentDurations<double> durations;
  const auto first = durations.at(0.01);
  EXPECT_TRUE(first.is_new);
  EXPECT_TRUE(durations.at(0.004).is_new);
  const auto again = durations.at(0.01);
  EXPECT_FALSE(again.is_new);
  EXPECT_EQ(again.index, first.index);
}

TEST(RecentDurations, ANewDurationReplacesTheOldestOne) {
  RecentDurations<double> durations;
  std::set<std::size_t> used;
  for (int i = 0; i < 4; ++i) used.insert(durations.at(0.01 * (i + 1)).index);
  ASSERT_EQ(used.size(), RecentDurations<double>::slots);
  const std::size_t index = durations.at(0.5).index;
  EXPECT_EQ(durations.find(0.5), index);
  EXPECT_FALSE(durations.find(0.01));
  EXPECT_TRUE(durations.find(0.02));
}

TEST(RecentDurations, FindStoresNothing) {
  RecentDurations<double> durations;
  EXPECT_FALSE(durations.find(0.0));
  EXPECT_FALSE(durations.find(0.01));
  EXPECT_TRUE(durations.at(0.01).is_new);
}

}  // namespace
}  // namespace softgrip::model::weight_cache_test
