#include "base/periodic_schedule.h"

#include <gtest/gtest.h>

#include <random>

namespace softgrip::daemon::periodic_schedule_test {
namespace {

constexpr Nanoseconds period = 1'000'000;

TEST(PeriodicSchedule, AdvancesByOnePeriodWhenOnTime) {
  PeriodicSchedule schedule(5, period);
  EXPECT_EQ(schedule.advance(700'000), 0U);
  EXPECT_EQ(schedule.due(), 5 + period);
}

TEST(PeriodicSchedule, ATickThatEndsAtTheNextDeadlineSkipsNothing) {
  PeriodicSchedule schedule(0, period);
  EXPECT_EQ(schedule.advance(period), 0U);
  EXPECT_EQ(schedule.due(), period);
}

TEST(PeriodicSchedule, SkipsToTheNextDeadlineAfterAnOverrun) {
  PeriodicSchedule schedule(0, period);
  EXPECT_EQ(schedule.advance(period + 1), 1U);
  EXPECT_EQ(schedule.due(), 2 * period);
  EXPECT_EQ(schedule.advance(10 * period + 3), 8U);
  EXPECT_EQ(schedule.due(), 11 * period);
}

TEST(PeriodicSchedule, KeepsThePhaseAndSchedulesNoPastDeadline) {
  const unsigned seed = 11;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  const Nanoseconds start = 12'345;
  PeriodicSchedule schedule(start, period);
  Nanoseconds now = start;
  std::uint64_t counted = 0;
  for (int tick = 0; tick < 10'000; ++tick) {
    const Nanoseconds longest = random() % 7 == 0 ? 20 * period : period / 2;
    now = std::max(now, schedule.due()) + static_cast<Nanoseconds>(random()) % longest;
    const Nanoseconds before = schedule.due();
    const std::uint64_t skipped = schedule.advance(now);
    counted += 1 + skipped;
    ASSERT_GE(schedule.due(), now);
    ASSERT_EQ((schedule.due() - start) % period, 0);
    ASSERT_EQ(schedule.due() - before, static_cast<Nanoseconds>(1 + skipped) * period);
    ASSERT_TRUE(skipped == 0 || schedule.due() - now < period)
        << "the schedule skipped a deadline in the future";
  }
  EXPECT_EQ(static_cast<Nanoseconds>(counted) * period, schedule.due() - start);
}

TEST(PeriodicSchedule, SleepsUntilAnAbsoluteTime) {
  timespec time{};
  clock_gettime(CLOCK_BOOTTIME, &time);
  const Nanoseconds begin = time.tv_sec * ns_per_s + time.tv_nsec;
  sleep_until(begin + 3 * period);
  sleep_until(begin + 3 * period);  // this time has already passed, so the call must return immediately
  clock_gettime(CLOCK_BOOTTIME, &time);
  EXPECT_GE(time.tv_sec * ns_per_s + time.tv_nsec, begin + 3 * period);
}

}  // namespace
}  // namespace softgrip::daemon::periodic_schedule_test
