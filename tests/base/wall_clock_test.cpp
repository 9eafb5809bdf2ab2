#include "base/wall_clock.h"

#include <gtest/gtest.h>

#include <ctime>

namespace softgrip::wall_clock_test {
namespace {

TEST(WallClock, TextsAreUtcAndSortAsTheirTimes) {
  constexpr Nanoseconds moment = 1'763'610'372'045'678'901;
  EXPECT_EQ(utc_text(moment), "2025-11-20T03:46:12Z");
  EXPECT_EQ(utc_text(moment, 3), "2025-11-20T03:46:12.045Z");
  EXPECT_EQ(utc_text(moment, 9), "2025-11-20T03:46:12.045678901Z");
  EXPECT_LT(utc_text(moment, 3), utc_text(moment + ns_per_s / 500, 3));
}

TEST(WallClock, AMomentOfTheOtherClockIsFoundOnTheWall) {
  timespec now{};
  clock_gettime(CLOCK_BOOTTIME, &now);
  const Nanoseconds moment = now.tv_sec * ns_per_s + now.tv_nsec;
  EXPECT_NEAR(seconds(wall_time_now() - wall_time(moment - 60 * ns_per_s)), 60, 5);
}

}  // namespace
}  // namespace softgrip::wall_clock_test
