#include "tools/plc/master_watch.h"

#include <gtest/gtest.h>

namespace softgrip::plc::master_watch_test {
namespace {

TEST(MasterWatch, TheTimeOutStartsWithTheFirstHeartbeat) {
  MasterWatch watch(100);
  EXPECT_FALSE(watch.watched());
  EXPECT_FALSE(watch.silent(1000));
  EXPECT_FALSE(watch.look(1000));
  EXPECT_FALSE(watch.owes());
  watch.beat(1000);
  EXPECT_TRUE(watch.watched());
  EXPECT_FALSE(watch.silent(1100));
  EXPECT_TRUE(watch.silent(1101));
}

TEST(MasterWatch, TheReactionIsDueOncePerTimeOutUntilConfirmed) {
  MasterWatch watch(100);
  watch.beat(1000);
  EXPECT_TRUE(watch.look(1101));
  EXPECT_TRUE(watch.owes());
  watch.beat(1200);  // the heartbeat has resumed, but the stop is still to be executed
  EXPECT_FALSE(watch.silent(1200));
  EXPECT_TRUE(watch.owes());
  watch.confirm();
  EXPECT_FALSE(watch.owes());
  EXPECT_FALSE(watch.look(1250));
  EXPECT_FALSE(watch.owes());
  EXPECT_TRUE(watch.look(1301));
  EXPECT_TRUE(watch.owes());
  watch.confirm();
  EXPECT_FALSE(watch.look(1400));  // no new silence, because the silence that was detected at 1301 continues
  EXPECT_FALSE(watch.owes());
  EXPECT_TRUE(watch.silent(1400));
}

TEST(MasterWatch, DetectsATimeOutAtTheNextHeartbeat) {
  MasterWatch watch(100);
  watch.beat(1000);
  watch.beat(1500);
  EXPECT_TRUE(watch.owes());
}

}  // namespace
}  // namespace softgrip::plc::master_watch_test
