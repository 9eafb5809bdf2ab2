#include "daemon/loop/thread.h"

#include <gtest/gtest.h>

#include "base/periodic_schedule.h"

namespace softgrip::daemon::heartbeat_test {
namespace {

TEST(Heartbeat, BeatsWhileAllCountsGrow) {
  Heartbeat heartbeat({10, 30});
  for (std::uint64_t i = 0; i < 100; ++i)
    EXPECT_TRUE(heartbeat.beats(static_cast<Nanoseconds>(i) * 10, {i, i}));
}

TEST(Heartbeat, StopsWhenACounterStallsBeyondTheTimeLimit) {
  for (const std::size_t hung : {std::size_t{0}, std::size_t{1}}) {
    Heartbeat heartbeat({10, 30});
    const Nanoseconds patience = hung == 0 ? 10 : 30;
    std::uint64_t count = 0;
    EXPECT_TRUE(heartbeat.beats(0, {5, 5}));
    for (Nanoseconds now = 1; now < 100; ++now) {
      ++count;
      EXPECT_EQ(heartbeat.beats(now, {hung == 0 ? 5 : 5 + count, hung == 1 ? 5 : 5 + count}), now <= patience)
          << "counter " << hung << " at " << now;
    }
  }
}

// After one hour of attempts to connect, the counter of the bus thread is far behind the counter of the
// control loop. If the loop then stalls, the counter of the bus thread continues to grow. This growth must
// not hide the stall of the loop.
TEST(Heartbeat, AGrowingLowerCounterDoesNotHideAStall) {
  Heartbeat heartbeat({10, 10});
  EXPECT_TRUE(heartbeat.beats(0, {1'000'000, 10}));
  std::uint64_t bus = 10;
  bool alive = true;
  for (Nanoseconds now = 1; now <= 11; ++now) alive = heartbeat.beats(now, {1'000'000, ++bus});
  EXPECT_FALSE(alive);
}

TEST(Heartbeat, BeatsAgainWhenTheCountGrowsAgain) {
  Heartbeat heartbeat({10});
  EXPECT_TRUE(heartbeat.beats(0, {1}));
  EXPECT_FALSE(heartbeat.beats(11, {1}));
  EXPECT_TRUE(heartbeat.beats(12, {2}));
}

}  // namespace
}  // namespace softgrip::daemon::heartbeat_test
