#include "tools/plc/handshake.h"

#include <gtest/gtest.h>

#include "tools/plc/master_watch.h"

namespace softgrip::plc::handshake_test {
namespace {

TEST(Handshake, ACounterIsCarriedOutOnceHoweverOftenItIsWritten) {
  Handshake handshake;
  EXPECT_FALSE(handshake.write(0, CommandCode::none));
  EXPECT_TRUE(handshake.write(1, CommandCode::start));
  EXPECT_EQ(handshake.outcome(), Outcome::executing);
  EXPECT_FALSE(handshake.write(1, CommandCode::start));
  handshake.finish(1, Outcome::accepted);
  EXPECT_FALSE(handshake.write(1, CommandCode::start));
  EXPECT_EQ(handshake.done_counter(), 1);
  EXPECT_EQ(handshake.outcome(), Outcome::accepted);
  EXPECT_TRUE(handshake.write(2, CommandCode::release));
}

TEST(Handshake, TheFirstCounterAfterTheStartIsRefused) {
  Handshake handshake;
  EXPECT_FALSE(handshake.synchronised());
  EXPECT_FALSE(handshake.write(17, CommandCode::start));
  EXPECT_TRUE(handshake.synchronised());
  EXPECT_EQ(handshake.done_counter(), 17);
  EXPECT_EQ(handshake.outcome(), Outcome::refused);
  EXPECT_EQ(handshake.reason(), Reason::first_after_start);
  EXPECT_FALSE(handshake.write(17, CommandCode::start));
  EXPECT_TRUE(handshake.write(18, CommandCode::start));
}

TEST(Handshake, ACounterWithoutACommandIsWhereAMasterBegins) {
  Handshake handshake;
  EXPECT_FALSE(handshake.write(0, CommandCode::none));
  EXPECT_FALSE(handshake.write(40, CommandCode::none));
  EXPECT_EQ(handshake.done_counter(), 40);
  EXPECT_EQ(handshake.outcome(), Outcome::none);
  EXPECT_TRUE(handshake.write(41, CommandCode::start));
  EXPECT_FALSE(handshake.write(50, CommandCode::none));
  EXPECT_EQ(handshake.outcome(), Outcome::executing);
}

TEST(Handshake, OnlyStopAndVentOvertake) {
  Handshake handshake;
  EXPECT_FALSE(handshake.write(0, CommandCode::none));
  EXPECT_TRUE(handshake.write(1, CommandCode::start));
  EXPECT_FALSE(handshake.write(2, CommandCode::release));
  EXPECT_TRUE(handshake.write(3, CommandCode::vent));
  handshake.finish(1, Outcome::accepted);  // too late: nobody asks any more
  EXPECT_EQ(handshake.outcome(), Outcome::executing);
  handshake.finish(3, Outcome::accepted);
  EXPECT_EQ(handshake.done_counter(), 3);
}

TEST(Handshake, WhatIsUnderWayWhenTheDaemonGoesIsUnknownAndNotSentAgain) {
  Handshake handshake;
  EXPECT_FALSE(handshake.write(0, CommandCode::none));
  handshake.lose();
  EXPECT_EQ(handshake.outcome(), Outcome::none);
  EXPECT_TRUE(handshake.write(1, CommandCode::start));
  handshake.lose();
  EXPECT_EQ(handshake.outcome(), Outcome::unknown);
  EXPECT_EQ(handshake.done_counter(), 1);
  EXPECT_FALSE(handshake.write(1, CommandCode::start));
}

TEST(Handshake, TheCounterMayWrap) {
  Handshake handshake;
  EXPECT_FALSE(handshake.write(65535, CommandCode::none));
  EXPECT_TRUE(handshake.write(0, CommandCode::stop));
}

TEST(MasterWatch, SilenceCountsFromTheFirstBeatAndIsToldOnce) {
  MasterWatch watch(100);
  watch.beat(0, 10);  // what the register holds anyway
  EXPECT_FALSE(watch.watched());
  EXPECT_FALSE(watch.silent(1000));
  watch.beat(1, 1000);
  EXPECT_FALSE(watch.falls_silent(1100));
  watch.beat(1, 1090);  // the same value is no beat
  EXPECT_TRUE(watch.falls_silent(1101));
  EXPECT_FALSE(watch.falls_silent(1200));
  EXPECT_TRUE(watch.silent(1200));
  watch.beat(2, 1300);
  EXPECT_FALSE(watch.silent(1400));
  EXPECT_TRUE(watch.falls_silent(1401));
}

}  // namespace
}  // namespace softgrip::plc::handshake_test
