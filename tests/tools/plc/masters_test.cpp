#include "tools/plc/masters.h"

#include <gtest/gtest.h>

#include "base/grid.h"

namespace softgrip::plc::masters_test {
namespace {

constexpr Nanoseconds minute = 60 * ns_per_s;

class Places : public ::testing::Test {
 protected:
  Masters::Id come(const std::string& address = "10.0.0.1") {
    const auto id = masters_.admit(address, now_);
    EXPECT_TRUE(id.has_value());
    return id.value_or(0);
  }
  void ask(Masters::Id id) {
    masters_.find(id)->asked = true;
    masters_.find(id)->asked_at = now_;
  }

  Masters masters_{3};
  Nanoseconds now_ = ns_per_s;
};

TEST_F(Places, AreFew) {
  for (int i = 0; i < 3; ++i) come();
  EXPECT_FALSE(masters_.admit("10.0.0.1", now_));
}

TEST_F(Places, WhoAsksNothingIsDropped) {
  const Masters::Id silent = come();
  const Masters::Id plc = come();
  now_ += minute - 1;
  ask(plc);
  masters_.drop_silent(now_, minute);
  EXPECT_TRUE(masters_.has(silent));
  ++now_;
  masters_.drop_silent(now_, minute);
  EXPECT_FALSE(masters_.has(silent));
  EXPECT_TRUE(masters_.has(plc));
}

TEST_F(Places, HalfARequestIsDroppedWhenAnotherConnectionWrites) {
  const Masters::Id whole = come();
  const Masters::Id half = come();
  const Masters::Id writer = come("10.0.0.2");
  masters_.find(half)->half = true;
  masters_.find(writer)->half = true;
  masters_.drop_halves(writer);
  EXPECT_TRUE(masters_.has(whole) && masters_.has(writer));
  EXPECT_FALSE(masters_.has(half));
}

TEST_F(Places, ALaterConnectionOfAnAddressBeginsWhereTheLastOneWas) {
  const Masters::Id first = come();
  EXPECT_FALSE(masters_.find(first)->cursor.at);
  masters_.find(first)->cursor.at = 7;
  masters_.find(first)->heartbeat = 30;
  masters_.remember_counter(*masters_.find(first));
  masters_.remember_heartbeat(*masters_.find(first));
  masters_.leave(first);
  const Masters::Id again = come();
  EXPECT_EQ(masters_.find(again)->cursor.at, 7);
  EXPECT_EQ(masters_.find(again)->heartbeat, 30);
  EXPECT_FALSE(masters_.find(come("10.0.0.2"))->cursor.at);
}

TEST(Written, HoldsNoCommandAtFirst) {
  Master master;
  EXPECT_EQ(command_in(master.written), Command{});
  at(master.written, Name::command) = 1;
  at(master.written, Name::displacement) = 12;
  EXPECT_EQ(command_in(master.written), (Command{1, 0, no_value, no_value, 12}));
}

}  // namespace
}  // namespace softgrip::plc::masters_test
