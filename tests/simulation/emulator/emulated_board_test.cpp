#include "simulation/emulator/emulated_board.h"

#include <gtest/gtest.h>

#include <random>

#include "rig/board_map_file.h"

namespace softgrip::simulation::emulated_board_test {
namespace {

constexpr Nanoseconds second = 1'000'000'000;

drivers::BoardMap adam() {
  document::Problems problems;
  auto map = rig::load_board_map(SOFTGRIP_SOURCE_DIR "/config/boards/adam-6024.yaml", problems);
  EXPECT_TRUE(map) << problems.format();
  return *map;
}

/// Returns the Modbus message (PDU) with function code 16 that writes both outputs of the ADAM-6024.
Bytes write_outputs(std::uint16_t first, std::uint16_t second_value) {
  Bytes pdu{0x10, 0, 10, 0, 2, 4};
  append_word(pdu, first);
  append_word(pdu, second_value);
  return pdu;
}

std::uint16_t read_one(EmulatedBoard& board, Nanoseconds now, std::uint8_t function, std::uint8_t address) {
  const Bytes reply = board.answer(now, Bytes{function, 0, address, 0, 1}).pdu;
  EXPECT_EQ(reply.size(), 4U);
  return reply.size() == 4 ? word_at(reply, 2) : std::uint16_t{0};
}

TEST(EmulatedBoard, OutputsFollowTheMapsScaling) {
  EmulatedBoard board(adam());
  EXPECT_FALSE(board.commanded());
  EXPECT_EQ(board.answer(0, write_outputs(4095, 819)).pdu, (Bytes{0x10, 0, 10, 0, 2}));
  EXPECT_TRUE(board.commanded());
  EXPECT_NEAR(board.output(0), 10, 1e-12);
  EXPECT_NEAR(board.output(1), 2, 1e-12);
  EXPECT_EQ(read_one(board, 0, 0x04, 10), 4095) << "the read-back equals the written output";
  EXPECT_EQ(read_one(board, 0, 0x03, 11), 819);
}

TEST(EmulatedBoard, LimitsARawValueToTheRangeOfTheConverter) {
  EmulatedBoard board(adam());
  board.answer(0, write_outputs(5000, 0xffff));
  EXPECT_NEAR(board.output(0), 10, 1e-12);
  EXPECT_EQ(read_one(board, 0, 0x04, 10), 4095);
}

TEST(EmulatedBoard, ShowsTheClientCountIfTheMapHasARegister) {
  drivers::BoardMap map = adam();
  EmulatedBoard silent(map);
  silent.count_clients(2);
  EXPECT_EQ(silent.answer(0, Bytes{0x04, 0, 30, 0, 1}).pdu, (Bytes{0x84, 2}))
      << "without a register for the number of clients in the board map, the request must be refused";
  for (const std::uint8_t function : {std::uint8_t{3}, std::uint8_t{4}}) {
    map.watchdog.clients = drivers::BoardWatchdog::ClientCount{.function = function, .address = 30};
    EmulatedBoard board(map);
    EXPECT_EQ(read_one(board, 0, function, 30), 0);
    board.count_clients(2);
    EXPECT_EQ(read_one(board, 0, function, 30), 2);
  }
}

TEST(EmulatedBoard, InputsShowVoltsAndTheirStatus) {
  EmulatedBoard board(adam());
  board.set_input(0, 5);
  board.set_input(1, 12);
  board.set_input(2, -12);
  EXPECT_EQ(read_one(board, 0, 0x04, 0), 49151);  // 5 V in the range -10 V to 10 V: (5 + 10) / 20 * 65535 =
                                                  // 49151.25
  EXPECT_EQ(read_one(board, 0, 0x04, 1), 65535);
  EXPECT_EQ(read_one(board, 0, 0x04, 2), 0);
  EXPECT_EQ(read_one(board, 0, 0x04, 20), 0);
  EXPECT_EQ(read_one(board, 0, 0x04, 21), 1);
  EXPECT_EQ(read_one(board, 0, 0x04, 22), 2);
}

TEST(EmulatedBoard, TheWatchdogVentsAndReportsTheTrip) {
  drivers::BoardMap map = adam();
  map.watchdog.timeout_s = 0.5;
  EmulatedBoard board(map);
  EXPECT_FALSE(board.watchdog_due()) << "the watchdog starts with the first request";
  board.answer(0, write_outputs(2000, 2000));
  EXPECT_EQ(board.watchdog_due(), second / 2);
  board.advance(second / 2 - 1);
  EXPECT_FALSE(board.tripped());
  board.advance(second / 2);
  EXPECT_TRUE(board.tripped());
  EXPECT_EQ(board.output(0), 0);
  EXPECT_EQ(read_one(board, second, 0x04, 10), 0) << "the read-back shows the actual output";
  EXPECT_TRUE(board.tripped()) << "a read request resets the watchdog timer but does not clear a trip";
  board.answer(second, write_outputs(1000, 1000));
  EXPECT_FALSE(board.tripped()) << "if the board map has no clearing write, any write clears the trip";
  EXPECT_GT(board.output(0), 2);
}

TEST(EmulatedBoard, AnyRequestFeedsTheWatchdog) {
  EmulatedBoard board(adam());
  board.answer(0, write_outputs(2000, 2000));
  for (int i = 1; i < 20; ++i) read_one(board, i * second / 10, 0x04, 0);
  EXPECT_FALSE(board.tripped());
}

TEST(EmulatedBoard, OnlyConfiguredFunctionsResetTheWatchdogTimer) {
  drivers::BoardMap map = adam();
  map.watchdog.feed = drivers::BoardWatchdog::Feed::functions;
  map.watchdog.functions = {0x10};
  EmulatedBoard board(map);
  board.answer(0, write_outputs(2000, 2000));
  for (int i = 1; i < 20; ++i) read_one(board, i * second / 10, 0x04, 0);
  EXPECT_TRUE(board.tripped());
}

TEST(EmulatedBoard, AHeartbeatFeedsTheWatchdogOnlyIfItChanges) {
  drivers::BoardMap map = adam();
  map.watchdog.feed = drivers::BoardWatchdog::Feed::feed_write;
  map.watchdog.feed_write = drivers::FixedWrite{.function = 6, .address = 100, .value = 0, .alternate = 1};
  const auto trips_with = [&](std::uint8_t second_value) {
    EmulatedBoard board(map);
    board.answer(0, write_outputs(2000, 2000));
    for (int i = 0; i < 20; ++i) {
      const std::uint8_t beat = i % 2 == 0 ? std::uint8_t{0} : second_value;
      board.answer(i * second / 10, Bytes{0x06, 0, 100, 0, beat});
    }
    return board.tripped();
  };
  EXPECT_FALSE(trips_with(1));
  EXPECT_TRUE(trips_with(0)) << "a repeated value does not count as a heartbeat";
  EXPECT_TRUE(trips_with(2)) << "a value other than the two heartbeat values does not count as a heartbeat";
}

TEST(EmulatedBoard, ALatchedTripIgnoresWritesUntilItIsCleared) {
  drivers::BoardMap map = adam();
  map.watchdog.clear = {drivers::FixedWrite{5, 0x1020, 1}};
  map.watchdog.tripped = drivers::BoardWatchdog::Tripped{1, 0x1021, 0xffff};
  EmulatedBoard board(map);
  board.answer(0, write_outputs(2000, 2000));
  board.advance(second);
  ASSERT_TRUE(board.tripped());
  EXPECT_EQ(board.answer(second, Bytes{0x01, 0x10, 0x21, 0, 1}).pdu, (Bytes{0x01, 1, 1}));
  board.answer(second, write_outputs(2000, 2000));
  EXPECT_EQ(board.output(0), 0) << "during a trip a write is confirmed but has no effect";
  board.answer(second, Bytes{0x05, 0x10, 0x20, 0xff, 0});
  EXPECT_FALSE(board.tripped());
  EXPECT_EQ(board.output(0), 0) << "the output changes only with the first write after the trip was cleared";
  board.answer(second, write_outputs(2000, 2000));
  EXPECT_GT(board.output(0), 4);
}

TEST(EmulatedBoard, IgnoredWritesAreConfirmed) {
  EmulatedBoard board(adam());
  board.answer(0, write_outputs(1000, 1000));
  board.ignore_writes(true);
  EXPECT_EQ(board.answer(0, write_outputs(3000, 3000)).pdu, (Bytes{0x10, 0, 10, 0, 2}));
  EXPECT_EQ(read_one(board, 0, 0x04, 10), 1000);
}

TEST(EmulatedBoard, AnswersEveryRequestWithAReplyOrAnException) {
  constexpr std::uint64_t seed = 20251120;
  SCOPED_TRACE(seed);
  std::mt19937_64 random(seed);
  EmulatedBoard board(adam());
  for (int i = 0; i < 100'000; ++i) {
    Bytes pdu(1 + random() % 20);
    for (std::uint8_t& byte : pdu)
      byte = static_cast<std::uint8_t>(random() % 4 == 0 ? random() : random() % 24);
    const Bytes reply = board.answer(i, pdu).pdu;
    ASSERT_GE(reply.size(), 2U);
    ASSERT_LE(reply.size(), max_pdu);
    ASSERT_EQ(reply[0] & 0x7fU, pdu[0] & 0x7fU);
  }
}

}  // namespace
}  // namespace softgrip::simulation::emulated_board_test
