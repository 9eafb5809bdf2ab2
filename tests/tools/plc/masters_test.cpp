#include "tools/plc/masters.h"

#include <gtest/gtest.h>

#include <vector>

#include "base/periodic_schedule.h"

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

TEST_F(Places, ANewConnectionReplacesTheMostIdleOneOfTheAddress) {
  std::vector<Masters::Id> dead;
  for (int i = 0; i < 3; ++i) {
    dead.push_back(come());
    ask(dead.back());
    now_ += ns_per_s;
  }
  const Masters::Id alive = come();
  EXPECT_FALSE(masters_.has(dead[0]));
  EXPECT_TRUE(masters_.has(dead[1]));
  EXPECT_TRUE(masters_.has(alive));
  now_ += ns_per_s;
  ask(alive);
  come();
  EXPECT_FALSE(masters_.has(dead[1]));
  EXPECT_TRUE(masters_.has(alive));
}

TEST_F(Places, AnActiveConnectionIsNotReplaced) {
  const Masters::Id plc = come();
  std::size_t admitted = 0;
  for (int i = 0; i < 1000; ++i) {
    if (i % 10 == 0) ask(plc);
    admitted += masters_.admit("10.0.0.1", now_) ? 1U : 0U;
    EXPECT_TRUE(masters_.has(plc));
    EXPECT_LE(masters_.all().size(), 3U);
    now_ += ns_per_s / 11;
  }
  EXPECT_GT(admitted, 100U);
}

TEST_F(Places, ReplacesAConnectionWithoutRequestsFirst) {
  const Masters::Id plc = come();
  ask(plc);
  now_ += ns_per_s;
  const Masters::Id first = come();
  const Masters::Id second = come();
  now_ += ns_per_s;
  come();
  EXPECT_TRUE(masters_.has(plc) && masters_.has(second));
  EXPECT_FALSE(masters_.has(first));
}

TEST_F(Places, ConnectionsWithoutRequestsDoNotReplaceAnIdleClient) {
  const Masters::Id plc = come();
  ask(plc);
  for (int i = 0; i < 1000; ++i) {
    now_ += ns_per_s / 20;
    static_cast<void>(masters_.admit("10.0.0.1", now_));
    EXPECT_TRUE(masters_.has(plc));
  }
}

TEST_F(Places, RefusesAConnectionIfNoConnectionIsIdle) {
  for (int i = 0; i < 3; ++i) ask(come());
  EXPECT_FALSE(masters_.admit("10.0.0.1", now_));
  now_ += ns_per_s;
  EXPECT_TRUE(masters_.admit("10.0.0.1", now_));
}

TEST_F(Places, ConnectionsOfOneAddressDoNotReplaceAnotherAddress) {
  const Masters::Id other = come("10.0.0.2");
  come();
  come();
  for (int i = 0; i < 10; ++i) {
    now_ += minute;
    come();
  }
  EXPECT_TRUE(masters_.has(other));
}

TEST_F(Places, ANewAddressReplacesAConnectionOfTheLargestAddress) {
  const Masters::Id first = come("10.0.0.2");
  const Masters::Id second = come("10.0.0.2");
  const Masters::Id other = come("10.0.0.3");
  for (const Masters::Id id : {first, second, other}) ask(id);
  const Masters::Id plc = come();
  EXPECT_FALSE(masters_.has(first));
  EXPECT_TRUE(masters_.has(second) && masters_.has(other) && masters_.has(plc));
  // Each address has one connection at this point, and the largest number of connections is reached.
  EXPECT_FALSE(masters_.admit("10.0.0.4", now_));
}

TEST_F(Places, ClosesAConnectionWithoutRequestsAfterTheTimeOut) {
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

TEST_F(Places, ClosesOtherConnectionsWithIncompleteRequests) {
  const Masters::Id whole = come();
  const Masters::Id half = come();
  const Masters::Id writer = come("10.0.0.2");
  masters_.find(half)->half = true;
  masters_.find(writer)->half = true;
  masters_.drop_halves(writer);
  EXPECT_TRUE(masters_.has(whole) && masters_.has(writer));
  EXPECT_FALSE(masters_.has(half));
}

TEST_F(Places, ANewConnectionContinuesTheCounterOfTheAddress) {
  const Masters::Id first = come();
  EXPECT_FALSE(masters_.find(first)->cursor.at);
  masters_.find(first)->cursor.at = 7;
  masters_.remember_counter(*masters_.find(first));
  masters_.leave(first);
  const Masters::Id again = come();
  EXPECT_EQ(masters_.find(again)->cursor.at, 7);
  EXPECT_FALSE(masters_.find(come("10.0.0.2"))->cursor.at);
}

TEST_F(Places, LosingSynchronisationAffectsAllConnectionsOfTheAddress) {
  const Masters::Id first = come();
  const Masters::Id other = come("10.0.0.2");
  for (const Masters::Id id : {first, other}) {
    masters_.find(id)->cursor.at = 7;
    masters_.remember_counter(*masters_.find(id));
  }
  const Masters::Id second = come();
  masters_.lose_step("10.0.0.1");
  EXPECT_FALSE(masters_.find(first)->cursor.at);
  EXPECT_FALSE(masters_.find(second)->cursor.at);
  EXPECT_EQ(masters_.find(other)->cursor.at, 7);
  masters_.leave(second);
  EXPECT_FALSE(masters_.find(come())->cursor.at);
}

TEST_F(Places, AHeartbeatIsAChangedValueOnOneConnection) {
  const Masters::Id first = come();
  const Masters::Id second = come();
  const Masters::Id other = come("10.0.0.2");
  const auto beats = [&](Masters::Id id, std::uint16_t value) {
    return masters_.take_heartbeat(*masters_.find(id), value);
  };
  EXPECT_FALSE(beats(first, 0));  // no change, because the register contains 0 from the start
  EXPECT_TRUE(beats(first, 5));
  EXPECT_FALSE(beats(second, 5));  // no change, because the two connections belong to the same master
  EXPECT_TRUE(beats(second, 6));
  EXPECT_FALSE(beats(first, 5));
  EXPECT_FALSE(beats(second, 6));
  EXPECT_TRUE(beats(other, 6));
}

TEST(Written, ContainsNoCommandInitially) {
  Master master;
  EXPECT_EQ(command_in(master.written), Command{});
  at(master.written, Name::command) = 1;
  at(master.written, Name::displacement) = 12;
  EXPECT_EQ(command_in(master.written), (Command{1, 0, no_value, no_value, 12}));
}

}  // namespace
}  // namespace softgrip::plc::masters_test
