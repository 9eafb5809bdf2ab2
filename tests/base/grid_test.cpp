#include "base/grid.h"

#include <gtest/gtest.h>

#include <random>

namespace softgrip::daemon::grid_test {
namespace {

constexpr Nanoseconds period = 1'000'000;

TEST(Grid, MovesOnByOnePeriodWhenInTime) {
  Grid grid(5, period);
  EXPECT_EQ(grid.advance(700'000), 0U);
  EXPECT_EQ(grid.due(), 5 + period);
}

TEST(Grid, ATickThatEndsExactlyWhenTheNextIsDueLosesNothing) {
  Grid grid(0, period);
  EXPECT_EQ(grid.advance(period), 0U);
  EXPECT_EQ(grid.due(), period);
}

TEST(Grid, SkipsToTheNextPointOfTheGridAfterAnOverrun) {
  Grid grid(0, period);
  EXPECT_EQ(grid.advance(period + 1), 1U);
  EXPECT_EQ(grid.due(), 2 * period);
  EXPECT_EQ(grid.advance(10 * period + 3), 8U);
  EXPECT_EQ(grid.due(), 11 * period);
}

TEST(Grid, NeverLosesItsPhaseNorTicksInThePast) {
  const unsigned seed = 11;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  const Nanoseconds start = 12'345;
  Grid grid(start, period);
  Nanoseconds now = start;
  std::uint64_t counted = 0;
  for (int tick = 0; tick < 10'000; ++tick) {
    const Nanoseconds longest = random() % 7 == 0 ? 20 * period : period / 2;
    now = std::max(now, grid.due()) + static_cast<Nanoseconds>(random()) % longest;
    const Nanoseconds before = grid.due();
    const std::uint64_t skipped = grid.advance(now);
    counted += 1 + skipped;
    ASSERT_GE(grid.due(), now);
    ASSERT_EQ((grid.due() - start) % period, 0);
    ASSERT_EQ(grid.due() - before, static_cast<Nanoseconds>(1 + skipped) * period);
    ASSERT_TRUE(skipped == 0 || grid.due() - now < period)
        << "a point of the grid was skipped that was still ahead";
  }
  EXPECT_EQ(static_cast<Nanoseconds>(counted) * period, grid.due() - start);
}

TEST(Grid, SleepsToATimeNotForADuration) {
  timespec time{};
  clock_gettime(CLOCK_BOOTTIME, &time);
  const Nanoseconds begin = time.tv_sec * ns_per_s + time.tv_nsec;
  sleep_until(begin + 3 * period);
  sleep_until(begin + 3 * period);  // already past: returns at once
  clock_gettime(CLOCK_BOOTTIME, &time);
  EXPECT_GE(time.tv_sec * ns_per_s + time.tv_nsec, begin + 3 * period);
}

}  // namespace
}  // namespace softgrip::daemon::grid_test
