#include "sysid/import/text_clock.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace softgrip::sysid::text_clock_test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Adds the cells to the clock and returns the times. An empty cell has no time.
std::vector<double> times_of(TextClock& clock, const std::vector<std::string>& cells,
                             const std::vector<int>& days = {}) {
  std::vector<double> times_s;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Nanoseconds day = days.empty() ? 0 : days[i] * 86400 * ns_per_s;
    times_s.push_back(cells[i].empty() ? nan : clock.add(cell_value(cells[i], {}), day));
  }
  return times_s;
}

struct Continued {
  std::vector<double> times_s;
  std::optional<Overflow> overflow;
};
Continued continued(const std::vector<std::string>& cells, const std::vector<int>& days = {}) {
  TextClock clock;
  Continued result{times_of(clock, cells, days), {}};
  std::vector<double> days_s;
  for (const int day : days) days_s.push_back(86400.0 * day);
  result.overflow = clock.continue_times(result.times_s, days_s);
  return result;
}

TEST(TextClock, MidnightAndTheEndOfAnHourAreContinued) {
  const Continued midnight = continued({"23:59:57", "23:59:59", "00:00:01", "00:00:03"});
  EXPECT_EQ(midnight.times_s, (std::vector<double>{0, 2, 4, 6}));
  ASSERT_TRUE(midnight.overflow);
  EXPECT_EQ(midnight.overflow->first, 2U);
  EXPECT_EQ(midnight.overflow->period, 86400);
  const Continued hour = continued({"59:58.0", "59:59.0", "00:00.0", "00:01.0"});
  EXPECT_EQ(hour.times_s, (std::vector<double>{0, 1, 2, 3}));
  ASSERT_TRUE(hour.overflow);
  EXPECT_EQ(hour.overflow->period, 3600);
}

TEST(TextClock, OtherDecreasesAreUnchanged) {
  for (const auto& [cells, last_s] :
       {std::pair(std::vector<std::string>{"34:54.0", "34:56.0", "34:58.0", "00:00.0"}, -2094.0),
        std::pair(std::vector<std::string>{"20:00:10", "20:00:11", "20:00:12", "03:00:00"}, -61210.0),
        std::pair(std::vector<std::string>{"23:59:57", "23:59:58", "23:59:59", "00:00:09"}, -86388.0),
        std::pair(
            std::vector<std::string>{"2024-05-31T23:59:58", "2024-05-31T23:59:59", "2024-05-31T00:00:00"},
            -86398.0)}) {
    const Continued result = continued(cells);
    EXPECT_FALSE(result.overflow) << cells.back();
    EXPECT_EQ(result.times_s.back(), last_s);
  }
}

TEST(TextClock, DatesAreUsedIfTheyChangeAtMidnight) {
  const Continued correct =
      continued({"23:59:58", "23:59:59", "00:00:00", "00:00:01", "00:00:00"}, {0, 0, 1, 1, 3});
  EXPECT_FALSE(correct.overflow);
  EXPECT_EQ(correct.times_s, (std::vector<double>{0, 1, 2, 3, 2 * 86400 + 2}));
}

TEST(TextClock, DatesThatChangeInAnotherRowThanMidnightAddNoDay) {
  const std::vector<std::string> cells{"23:59:57", "23:59:58", "", "23:59:59", "00:00:00", "00:00:01"};
  for (const std::vector<int>& days :
       {std::vector<int>{0, 0, 0, 0, 0, 1}, {0, 0, 0, 1, 1, 1}, {0, 0, 0, 0, 0, 0}}) {
    const Continued result = continued(cells, days);
    ASSERT_TRUE(result.overflow);
    EXPECT_EQ(result.overflow->first, 4U);
    EXPECT_TRUE(std::isnan(result.times_s[2]));
    EXPECT_EQ(result.times_s[3], 2);
    EXPECT_EQ(result.times_s[4], 3);
    EXPECT_EQ(result.times_s[5], 4);
  }
}

TEST(TextClock, MidnightIsADecreaseByMoreThanHalfADay) {
  TextClock clock;
  (void)times_of(clock, {"23:00:00", "11:00:00"});
  EXPECT_FALSE(clock.is_midnight());
  (void)times_of(clock, {"23:00:00", "10:59:59"});
  EXPECT_TRUE(clock.is_midnight());
  (void)times_of(clock, {"11:00:00"});
  EXPECT_FALSE(clock.is_midnight());
}

}  // namespace
}  // namespace softgrip::sysid::text_clock_test
