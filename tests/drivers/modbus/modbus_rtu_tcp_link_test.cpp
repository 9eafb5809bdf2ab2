// Tests RTU frames on a TCP connection that the server closes. Two other files test the contents of the
// frames: tests/simulation/emulator/board_habits_test.cpp with the emulator, and modbus_rtu_link_test.cpp on
// a serial line.

#include "drivers/modbus/modbus_rtu_link.h"

#include <gtest/gtest.h>

#include <cerrno>

#include "base/clock.h"
#include "drivers/modbus/modbus_link.h"
#include "tests/drivers/modbus/scripted_server.h"

namespace softgrip::drivers::modbus_rtu_tcp_link_test {
namespace {

constexpr Nanoseconds generous = 5'000'000'000;
constexpr ModbusRequest read_two{.function = 4, .address = 3, .count = 2};

TcpAddress rtu_at(std::uint16_t port) {
  return {.host = "127.0.0.1", .port = port, .rtu_framing = true, .silence_s = 0.004};
}

TEST(ModbusRtuTcpLink, ReportsAConnectionClosedBeforeTheFirstResponse) {
  // The test stops the server before the first request, so the connection is closed before the first
  // response.
  auto server = std::make_unique<test::ScriptedServer>([](test::Peer&, const test::Bytes&, std::size_t) {});
  ModbusRtuTcpLink link(rtu_at(server->port()));
  ASSERT_EQ(link.open(monotonic_now() + generous), BusStatus::ok) << link.detail();
  server.reset();
  EXPECT_EQ(link.ask(1, read_two, monotonic_now() + generous), BusStatus::closed_at_once) << link.detail();
  EXPECT_FALSE(link.is_open());
  EXPECT_EQ(link.open(monotonic_now() + generous), BusStatus::disconnected);
  EXPECT_NE(std::string(link.detail()).find("refused"), std::string::npos) << link.detail();
}

TEST(ModbusRtuTcpLink, TheExchangeTimeIncludesTheSilentIntervals) {
  const std::vector<TransactionSize> pair{{5, 5}, {5, 4}};
  const ModbusRtuTcpLink link(rtu_at(1));
  const Board::Budget cost = link.cost(pair, "plan");
  EXPECT_NEAR(cost.exchange_s, 2 * 0.15e-3 + 2 * 4e-3, 1e-6);
  EXPECT_NE(cost.explanation.find("8 ms"), std::string::npos) << cost.explanation;
  EXPECT_EQ(link.describe(), "127.0.0.1:1 (RTU frames)");
}

TEST(TcpSocket, ReportsWhyAConnectionFails) {
  EXPECT_STREQ(connect_tcp({.host = "board.example", .port = 502}, monotonic_now() + generous).why,
               "not a numeric address");
  EXPECT_EQ(connect_tcp({.host = "127.0.0.1", .port = 1}, monotonic_now() + generous).status,
            BusStatus::disconnected);
  EXPECT_TRUE(is_closed(EPIPE));
  EXPECT_FALSE(is_closed(EAGAIN));
  EXPECT_EQ(send_whole(-1, {}), EBADF);
}

}  // namespace
}  // namespace softgrip::drivers::modbus_rtu_tcp_link_test
