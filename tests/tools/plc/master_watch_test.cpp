#include "tools/plc/master_watch.h"

#include <gtest/gtest.h>

namespace softgrip::plc::master_watch_test {
namespace {

TEST(MasterWatch, SilenceCountsFromTheFirstBeatAndIsToldOnce) {
  MasterWatch watch(100);
  EXPECT_FALSE(watch.watched());
  EXPECT_FALSE(watch.silent(1000));
  watch.beat(1000);
  EXPECT_FALSE(watch.falls_silent(1100));
  EXPECT_TRUE(watch.falls_silent(1101));
  EXPECT_FALSE(watch.falls_silent(1200));
  EXPECT_TRUE(watch.silent(1200));
  watch.beat(1300);
  EXPECT_FALSE(watch.silent(1400));
  EXPECT_TRUE(watch.falls_silent(1401));
}

}  // namespace
}  // namespace softgrip::plc::master_watch_test
