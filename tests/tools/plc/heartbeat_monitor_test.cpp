#include "tools/plc/heartbeat_monitor.h"

#include <gtest/gtest.h>

namespace softgrip::plc::heartbeat_monitor_test {
namespace {

using State = HeartbeatMonitor::State;

TEST(HeartbeatMonitor, TheTimeOutStartsWithTheFirstHeartbeat) {
  HeartbeatMonitor monitor(100);
  EXPECT_EQ(monitor.state_of("plc", 1000), State::not_watched);
  EXPECT_FALSE(monitor.check(1000));
  EXPECT_FALSE(monitor.stop_required());
  monitor.on_change("plc", 1000);
  EXPECT_EQ(monitor.state_of("plc", 1100), State::alive);
  EXPECT_EQ(monitor.state_of("plc", 1101), State::silent);
}

TEST(HeartbeatMonitor, TheReactionIsDueOncePerTimeOutUntilConfirmed) {
  HeartbeatMonitor monitor(100);
  monitor.on_change("plc", 1000);
  EXPECT_TRUE(monitor.check(1101));
  EXPECT_TRUE(monitor.stop_required());
  monitor.on_change("plc", 1200);  // the heartbeat has resumed, but the stop is still to be executed
  EXPECT_EQ(monitor.state_of("plc", 1200), State::alive);
  EXPECT_TRUE(monitor.stop_required());
  monitor.confirm();
  EXPECT_FALSE(monitor.stop_required());
  EXPECT_FALSE(monitor.check(1250));
  EXPECT_FALSE(monitor.stop_required());
  EXPECT_TRUE(monitor.check(1301));
  EXPECT_TRUE(monitor.stop_required());
  monitor.confirm();
  // There is no new silence, because the silence that was detected at 1301 continues.
  EXPECT_FALSE(monitor.check(1400));
  EXPECT_FALSE(monitor.stop_required());
  EXPECT_EQ(monitor.state_of("plc", 1400), State::silent);
}

TEST(HeartbeatMonitor, AnotherClientDoesNotReplaceASilentClient) {
  HeartbeatMonitor monitor(100);
  monitor.on_change("plc", 1000);
  monitor.on_change("panel", 1080);
  EXPECT_FALSE(monitor.check(1100));
  EXPECT_TRUE(monitor.check(1101));
  EXPECT_TRUE(monitor.stop_required());
  EXPECT_EQ(monitor.state_of("plc", 1101), State::silent);
  EXPECT_EQ(monitor.state_of("panel", 1101), State::alive);
  EXPECT_EQ(monitor.state_of("client without a heartbeat", 1101), State::silent);
  monitor.confirm();
  monitor.on_change("panel", 1150);  // the silence of the PLC continues, and was reported before
  EXPECT_FALSE(monitor.stop_required());
  EXPECT_TRUE(monitor.check(1251));  // the second client becomes silent, too
  EXPECT_EQ(monitor.watched().size(), 2U);
}

}  // namespace
}  // namespace softgrip::plc::heartbeat_monitor_test
