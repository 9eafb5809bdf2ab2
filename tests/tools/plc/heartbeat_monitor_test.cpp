#include "tools/plc/heartbeat_monitor.h"

#include <gtest/gtest.h>

namespace softgrip::plc::heartbeat_monitor_test {
namespace {

TEST(HeartbeatMonitor, TheTimeOutStartsWithTheFirstHeartbeat) {
  HeartbeatMonitor monitor(100);
  EXPECT_FALSE(monitor.active());
  EXPECT_FALSE(monitor.silent(1000));
  EXPECT_FALSE(monitor.check(1000));
  EXPECT_FALSE(monitor.stop_required());
  monitor.on_change(1000);
  EXPECT_TRUE(monitor.active());
  EXPECT_FALSE(monitor.silent(1100));
  EXPECT_TRUE(monitor.silent(1101));
}

TEST(HeartbeatMonitor, TheReactionIsDueOncePerTimeOutUntilConfirmed) {
  HeartbeatMonitor monitor(100);
  monitor.on_change(1000);
  EXPECT_TRUE(monitor.check(1101));
  EXPECT_TRUE(monitor.stop_required());
  monitor.on_change(1200);  // the heartbeat has resumed, but the stop is still to be executed
  EXPECT_FALSE(monitor.silent(1200));
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
  EXPECT_TRUE(monitor.silent(1400));
}

TEST(HeartbeatMonitor, DetectsATimeOutAtTheNextHeartbeat) {
  HeartbeatMonitor monitor(100);
  monitor.on_change(1000);
  monitor.on_change(1500);
  EXPECT_TRUE(monitor.stop_required());
}

}  // namespace
}  // namespace softgrip::plc::heartbeat_monitor_test
