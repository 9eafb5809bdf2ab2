#include "tools/plc/handshake.h"

#include <gtest/gtest.h>

namespace softgrip::plc::handshake_test {
namespace {

constexpr Command none{0};
constexpr Command start{1, 1};
constexpr Command stop{2};
constexpr Command vent{3};
constexpr Command release{4};

struct Executing {
  Handshake handshake;
  Cursor plc;
};

/// Returns a handshake that executes its first command.
Executing executing(const Command& command) {
  Executing result;
  EXPECT_FALSE(result.handshake.write(result.plc, {0, none}));
  EXPECT_TRUE(result.handshake.write(result.plc, {1, command}));
  return result;
}

TEST(Handshake, ExecutesARepeatedCounterOnce) {
  auto [handshake, plc] = executing(start);
  EXPECT_EQ(handshake.outcome(), Outcome::executing);
  EXPECT_FALSE(handshake.write(plc, {1, start}));
  handshake.finish(1, Outcome::accepted);
  EXPECT_FALSE(handshake.write(plc, {1, start}));
  EXPECT_EQ(handshake.done_counter(), 1);
  EXPECT_EQ(handshake.outcome(), Outcome::accepted);
  EXPECT_FALSE(plc.refused);
  EXPECT_TRUE(handshake.write(plc, {2, release}));
}

TEST(Handshake, TheFirstCounterAfterTheStartIsRefused) {
  Handshake handshake;
  Cursor plc;
  EXPECT_FALSE(handshake.write(plc, {17, start}));
  EXPECT_EQ(handshake.done_counter(), 17);
  EXPECT_EQ(handshake.outcome(), Outcome::refused);
  EXPECT_EQ(handshake.reason(), Reason::first_after_start);
  EXPECT_FALSE(handshake.write(plc, {17, start}));
  EXPECT_FALSE(plc.refused);
  EXPECT_TRUE(handshake.write(plc, {18, start}));
}

TEST(Handshake, TheFirstCounterWithoutACommandSynchronises) {
  Handshake handshake;
  Cursor plc;
  EXPECT_FALSE(handshake.write(plc, {40, none}));
  EXPECT_EQ(handshake.done_counter(), 40);
  EXPECT_EQ(handshake.outcome(), Outcome::none);
  EXPECT_TRUE(handshake.write(plc, {41, start}));
}

TEST(Handshake, OnlyTheNextCounterIsExecuted) {
  auto [handshake, plc] = executing(start);
  handshake.finish(1, Outcome::accepted);
  EXPECT_TRUE(handshake.write(plc, {2, vent}));
  handshake.finish(2, Outcome::accepted);
  for (const int wrong : {0, 1, 4, 5, 40000, 65535}) {
    EXPECT_FALSE(handshake.write(plc, {static_cast<std::uint16_t>(wrong), start})) << wrong;
    EXPECT_TRUE(plc.refused) << wrong;
    // The gateway must refuse a wrong counter even if the block contains no command.
    EXPECT_FALSE(handshake.write(plc, {static_cast<std::uint16_t>(wrong), none})) << wrong;
    EXPECT_TRUE(plc.refused) << wrong;
  }
  // The refusals must not change the outcome of the last command. The command with the next counter must be
  // executed.
  EXPECT_EQ(handshake.done_counter(), 2);
  EXPECT_EQ(handshake.outcome(), Outcome::accepted);
  EXPECT_TRUE(handshake.write(plc, {3, start}));
  EXPECT_FALSE(plc.refused);
}

TEST(Handshake, ABlockThatArrivesLateOnAnotherConnectionIsRefused) {
  Handshake handshake;
  Cursor first;
  Cursor second;
  EXPECT_FALSE(handshake.write(first, {0, none}));
  EXPECT_FALSE(handshake.write(second, {0, none}));
  EXPECT_TRUE(handshake.write(second, {1, start}));
  handshake.finish(1, Outcome::accepted);
  EXPECT_TRUE(handshake.write(second, {2, vent}));
  handshake.finish(2, Outcome::accepted);
  // The blocks of the first connection arrive late, but in the order in which they were sent.
  EXPECT_FALSE(handshake.write(first, {1, start}));
  EXPECT_TRUE(first.refused);
  EXPECT_FALSE(handshake.write(first, {2, start}));
  EXPECT_TRUE(first.refused);
  EXPECT_FALSE(handshake.write(first, {3, start}));
  EXPECT_TRUE(first.refused);
  EXPECT_FALSE(second.refused);
  EXPECT_EQ(handshake.done_counter(), 2);
  // After this connection has written the newest counter, it may send commands.
  EXPECT_FALSE(handshake.write(first, {2, none}));
  EXPECT_FALSE(first.refused);
  EXPECT_TRUE(handshake.write(first, {3, start}));
}

TEST(Handshake, RefusesASecondClientWithAnotherCommandAtTheSameCounter) {
  Handshake handshake;
  Cursor first;
  Cursor second;
  EXPECT_FALSE(handshake.write(first, {0, none}));
  EXPECT_FALSE(handshake.write(second, {0, none}));
  EXPECT_TRUE(handshake.write(first, {1, start}));
  EXPECT_FALSE(handshake.write(second, {1, vent}));  // refused; otherwise, this master would read that its
                                                     // vent was accepted
  EXPECT_TRUE(second.refused);
  handshake.finish(1, Outcome::accepted);
  EXPECT_FALSE(handshake.write(second, {1, vent}));
  EXPECT_TRUE(second.refused);
  // When a master opens a new connection, it sends its last block a second time.
  Cursor again;
  EXPECT_FALSE(handshake.write(again, {1, start}));
  EXPECT_FALSE(again.refused);
}

TEST(Handshake, ACommandWithoutANewCounterIsNeitherExecutedNorRefused) {
  auto [handshake, plc] = executing(start);
  handshake.finish(1, Outcome::accepted);
  EXPECT_FALSE(handshake.write(plc, {1, vent}));  // not refused, because a master may write the new counter
                                                  // one cycle after the new command
  EXPECT_FALSE(plc.refused);
  EXPECT_EQ(handshake.outcome(), Outcome::accepted);
  EXPECT_TRUE(handshake.write(plc, {2, vent}));
}

TEST(Handshake, OnlyStopAndVentSupersedeAnExecutingCommand) {
  auto [handshake, plc] = executing(start);
  EXPECT_FALSE(handshake.write(plc, {2, release}));
  EXPECT_TRUE(handshake.has_waiting());
  EXPECT_FALSE(handshake.take_waiting());
  EXPECT_FALSE(handshake.write(plc, {3, release}));  // refused, because another command already waits
  EXPECT_TRUE(plc.refused);
  EXPECT_TRUE(handshake.write(plc, {3, vent}));
  EXPECT_FALSE(handshake.has_waiting());
  handshake.finish(1, Outcome::accepted);  // not reported, because a later command has superseded this
                                           // command
  EXPECT_EQ(handshake.outcome(), Outcome::executing);
  handshake.finish(3, Outcome::accepted);
  EXPECT_EQ(handshake.done_counter(), 3);
  EXPECT_FALSE(handshake.take_waiting());
}

TEST(Handshake, AQueuedCommandIsExecutedOnce) {
  auto [handshake, plc] = executing(release);
  EXPECT_FALSE(handshake.write(plc, {2, start}));
  EXPECT_FALSE(handshake.write(plc, {2, start}));
  EXPECT_FALSE(plc.refused);
  handshake.finish(1, Outcome::accepted);
  const auto entry = handshake.take_waiting();
  ASSERT_TRUE(entry);
  EXPECT_EQ(*entry, (Handshake::Entry{2, start}));
  EXPECT_EQ(handshake.outcome(), Outcome::executing);
  EXPECT_FALSE(handshake.take_waiting());
}

TEST(Handshake, AQueuedCommandIsRefusedAfterAnInternalStop) {
  auto [handshake, plc] = executing(release);
  EXPECT_FALSE(handshake.write(plc, {2, start}));
  handshake.refuse_waiting(Reason::client_silent);
  handshake.finish(1, Outcome::accepted);
  EXPECT_EQ(handshake.take_waiting()->refusal, Reason::client_silent);
}

TEST(Handshake, ACommandIsUnknownAndNotRepeatedAfterADaemonLoss) {
  Handshake handshake;
  Cursor plc;
  EXPECT_FALSE(handshake.write(plc, {0, none}));
  handshake.on_daemon_lost();
  EXPECT_EQ(handshake.outcome(), Outcome::none);
  EXPECT_TRUE(handshake.write(plc, {1, start}));
  handshake.on_daemon_lost();
  EXPECT_EQ(handshake.outcome(), Outcome::unknown);
  EXPECT_EQ(handshake.done_counter(), 1);
  EXPECT_FALSE(handshake.write(plc, {1, start}));
}

TEST(Handshake, ReturnsTheSignedDistanceOfACounter) {
  Handshake handshake;
  Cursor plc;
  EXPECT_EQ(handshake.ahead(7), 0);
  EXPECT_FALSE(handshake.write(plc, {65535, none}));
  EXPECT_EQ(handshake.ahead(65535), 0);
  EXPECT_EQ(handshake.ahead(0), 1);
  EXPECT_EQ(handshake.ahead(4), 5);
  EXPECT_EQ(handshake.ahead(65530), -5);
}

TEST(Handshake, TheCounterMayWrap) {
  Handshake handshake;
  Cursor plc;
  EXPECT_FALSE(handshake.write(plc, {65534, none}));
  EXPECT_TRUE(handshake.write(plc, {65535, stop}));
  handshake.finish(65535, Outcome::accepted);
  EXPECT_TRUE(handshake.write(plc, {0, stop}));
  handshake.finish(0, Outcome::accepted);
  EXPECT_FALSE(handshake.write(plc, {65535, stop}));
  EXPECT_TRUE(plc.refused);
}

}  // namespace
}  // namespace softgrip::plc::handshake_test
