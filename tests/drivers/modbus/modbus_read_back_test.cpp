// Tests the status that the driver derives from the outputs that it reads back from a board.

#include "drivers/modbus/modbus_board.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "tests/drivers/modbus/modbus_board_fixture.h"

namespace softgrip::drivers::modbus_read_back_test {
namespace {

using test::ModbusBoardTest;
using test::RegisterServer;
using test::Requests;
using test::shipped;

TEST_F(ModbusBoardTest, ReportsAnOutputThatDiffersFromTheCommand) {
  BoardMap map = shipped("adam-6024.yaml");
  map.read_back->lag_exchanges = 0;
  connect(map);
  ASSERT_EQ(exchange(10, 10), BusStatus::ok);
  server_.ignore_writes(true);
  EXPECT_EQ(exchange(10.01, 10), BusStatus::ok) << "the difference is within the read-back tolerance";
  EXPECT_EQ(exchange(50, 10), BusStatus::write_refused);
  EXPECT_NE(std::string(board_->detail()).find("left"), std::string::npos) << board_->detail();
  server_.ignore_writes(false);
  EXPECT_EQ(exchange(50, 10), BusStatus::ok);
}

// In this test, another Modbus client writes to one output after the write of the daemon. The daemon then
// reads the outputs back.
TEST_F(ModbusBoardTest, ARefusedExchangeReportsTheDifferingOutputs) {
  BoardMap map = shipped("adam-6024.yaml");
  map.read_back->lag_exchanges = 0;
  connect(map);
  ASSERT_EQ(exchange(40, 60), BusStatus::ok);
  EXPECT_TRUE(std::isnan(board_->found_kpa(1)));
  bool writes = true;
  server_.on_request([&writes](RegisterServer& server, const RegisterServer::Request& request) {
    if (writes && request.function != 16) server.holding_[11] = 819;
    server.input_[10] = server.holding_[10];
    server.input_[11] = server.holding_[11];
  });
  EXPECT_EQ(exchange(40, 60), BusStatus::write_refused);
  EXPECT_TRUE(std::isnan(board_->found_kpa(0))) << "the output equals the written value";
  EXPECT_NEAR(board_->found_kpa(1), 20, 0.1);
  writes = false;
  EXPECT_EQ(exchange(40, 20), BusStatus::ok);
  EXPECT_TRUE(std::isnan(board_->found_kpa(1)));
}

TEST_F(ModbusBoardTest, DetectsAWriteOfAnotherClientWithinEightExchanges) {
  connect(shipped("adam-6024.yaml"));
  for (int i = 0; i < 40; ++i) ASSERT_EQ(exchange(i, 100 - i), BusStatus::ok) << board_->detail();
  int until_noticed = 0;
  BusStatus status = BusStatus::ok;
  while (status == BusStatus::ok && until_noticed < 20) {
    server_.set_holding(11, 0);
    status = exchange(40, 60);
    ++until_noticed;
  }
  EXPECT_EQ(status, BusStatus::overwritten);
  EXPECT_LE(until_noticed, 8);
  EXPECT_NE(std::string(board_->detail()).find("channel 'right': another client"), std::string::npos)
      << board_->detail();
  EXPECT_EQ(server_.holding_[11], 0)
      << "the exchange that detects the other client does not write to the output";
  EXPECT_EQ(exchange(0, 0), BusStatus::ok);
}

// This output ignores writes, so its read-back differs from the written value. The driver must not conclude
// that another client has written to the output.
TEST_F(ModbusBoardTest, AnIgnoredWriteIsNotReportedAsAWriteOfAnotherClient) {
  BoardMap map = shipped("adam-6024.yaml");
  map.read_back->lag_exchanges = 0;
  connect(map);
  for (int first = 0; first < 8; ++first) {
    ASSERT_EQ(exchange(10, 10), BusStatus::ok) << board_->detail();
    server_.ignore_writes(true);
    ASSERT_NE(exchange(50, 10), BusStatus::overwritten)
        << "an exchange that reads the outputs first finds the last accepted command";
    for (int i = 0; i < 16 + first; ++i) ASSERT_EQ(exchange(50, 10), BusStatus::write_refused) << i;
    server_.ignore_writes(false);
  }
}

TEST_F(ModbusBoardTest, AWriteOfAFailedExchangeIsNotReportedAsAnotherClient) {
  connect(shipped("adam-6024.yaml"));
  for (int i = 0; i < 9; ++i) {
    for (int good = 0; good < 6; ++good) ASSERT_EQ(exchange(i, i), BusStatus::ok) << board_->detail();
    server_.refuse(4);
    ASSERT_EQ(exchange(50 + i, 50 + i), BusStatus::exception);
    server_.refuse({});
    ASSERT_EQ(exchange(50 + i, 50 + i), BusStatus::ok) << board_->detail();
  }
}

TEST_F(ModbusBoardTest, DistinguishesARefusedWriteFromAWriteOfAnotherClient) {
  BoardMap map = shipped("adam-6024.yaml");
  map.read_back->lag_exchanges = 0;
  connect(map);
  for (int i = 0; i < 20; ++i) ASSERT_EQ(exchange(40, 60), BusStatus::ok) << board_->detail();
  server_.ignore_writes(true);
  for (int i = 0; i < 20; ++i) ASSERT_EQ(exchange(50, 70), BusStatus::write_refused);
  server_.ignore_writes(false);
  ASSERT_EQ(exchange(50, 70), BusStatus::ok);
  server_.set_holding(11, 0);
  EXPECT_EQ(exchange(50, 70), BusStatus::overwritten)
      << "this exchange must begin with a read request for the outputs";
}

TEST_F(ModbusBoardTest, ReadingFirstNeedsNoAdditionalRequest) {
  connect(shipped("adam-6024.yaml"));
  ASSERT_EQ(exchange(1, 1), BusStatus::ok);
  (void)server_.take_requests();
  int first = 0;
  for (int i = 0; i < 16; ++i) {
    ASSERT_EQ(exchange(1, 1), BusStatus::ok);
    const Requests requests = server_.take_requests();
    ASSERT_EQ(requests.size(), 4U);
    const bool writes_last = requests.back().function == 16;
    EXPECT_NE(writes_last, requests.front().function == 16);
    first += writes_last ? 1 : 0;
  }
  EXPECT_EQ(first, 2);
}

TEST_F(ModbusBoardTest, DetectsAnotherClientWithFunction23) {
  wiring_ = test::two_fingers(false);
  connect(shipped("softgrip-sim.yaml"));
  server_.on_request([](RegisterServer& server, const RegisterServer::Request& request) {
    for (std::size_t i = 0; i < request.written.size(); ++i) {
      server.holding_[static_cast<std::uint16_t>(24 + i)] = request.written[i];
    }
  });
  for (int i = 0; i < 40; ++i) ASSERT_EQ(exchange(i, 100 - i), BusStatus::ok) << board_->detail();
  BusStatus status = BusStatus::ok;
  for (int i = 0; i < 8 && status == BusStatus::ok; ++i) {
    server_.set_holding(24, 0);
    status = exchange(40, 60);
  }
  EXPECT_EQ(status, BusStatus::overwritten) << board_->detail();
}

// On some boards, the read-back shows the command of the previous exchange. This happens in particular if one
// request with function code 23 writes and reads.
TEST_F(ModbusBoardTest, AcceptsAReadBackLagUpToTheLimitOfTheBoardMap) {
  BoardMap map = shipped("adam-6024.yaml");
  map.read_back->lag_exchanges = 1;
  server_.on_request([](RegisterServer& server, const RegisterServer::Request& request) {
    if (request.function != 16)
      return;  // the hook runs before the write, so the read-back gets the value of the previous write
    server.input_[10] = server.holding_[10];
    server.input_[11] = server.holding_[11];
  });
  connect(map);
  for (int i = 0; i < 50; ++i) ASSERT_EQ(exchange(i, 100 - i), BusStatus::ok) << board_->detail();
  map.read_back->lag_exchanges = 0;
  connect(map);
  EXPECT_EQ(exchange(70, 70), BusStatus::write_refused);
  map.read_back->lag_exchanges = 1;
  connect(map);
  ASSERT_EQ(exchange(10, 10), BusStatus::ok);
  ASSERT_EQ(exchange(10, 10), BusStatus::ok);
  server_.ignore_writes(true);
  ASSERT_EQ(exchange(50, 10), BusStatus::ok)
      << "the read-back may still show the command of the previous exchange";
  EXPECT_EQ(exchange(50, 10), BusStatus::write_refused)
      << "the read-back value may lag by at most one exchange";
}

}  // namespace
}  // namespace softgrip::drivers::modbus_read_back_test
