#pragma once
// Connects the driver of a Modbus board with a Modbus server over real sockets. Used by the tests of
// exchanges, read-back and watchdog.

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "drivers/modbus/modbus_board.h"
#include "rig/board_map_file.h"
#include "tests/drivers/modbus/on_tcp.h"
#include "tests/drivers/modbus/register_server.h"
#include "tests/drivers/modbus/two_fingers.h"

namespace softgrip::drivers::test {

using Requests = std::vector<RegisterServer::Request>;

constexpr auto generous = std::chrono::seconds(5);

inline BoardMap shipped(const std::string& name) {
  document::Problems problems;
  auto map = rig::load_board_map(SOFTGRIP_SOURCE_DIR "/config/boards/" + name, problems);
  if (!map.has_value()) throw std::runtime_error(problems.format());
  return *map;
}

/// Returns the raw value of an ADAM-6024 input register for an input voltage.
inline std::uint16_t adam_raw(double volt) {
  return static_cast<std::uint16_t>(std::lround((volt + 10) / 20 * 65535));
}

class ModbusBoardTest : public testing::Test {
 protected:
  ModbusBoardTest() {
    for (std::uint16_t input = 0; input < 6; ++input) server_.set_input(input, adam_raw(5));
    // Input registers 10 and 11 show the outputs, as on an ADAM-6024.
    server_.on_request([](RegisterServer& server, const RegisterServer::Request&) {
      server.input_[10] = server.holding_[10];
      server.input_[11] = server.holding_[11];
    });
  }

  ModbusSettings settings(const BoardMap& map) const { return on_tcp(server_.port(), map, wiring_, 0); }

  /// Creates the board, connects it to the server, and discards the requests that the server received during
  /// the connection.
  void connect(const BoardMap& map) {
    board_ = std::make_unique<ModbusBoard>(settings(map));
    ASSERT_EQ(board_->connect(generous), BusStatus::ok) << board_->detail();
    (void)server_.take_requests();
  }

  BusStatus exchange(double left_kpa, double right_kpa, std::chrono::nanoseconds deadline = generous) {
    const std::vector<double> commands{left_kpa, right_kpa};
    return board_->exchange(commands, readings_, deadline);
  }

  RegisterServer server_;
  std::vector<ChannelWiring> wiring_ = two_fingers();
  std::unique_ptr<ModbusBoard> board_;
  std::vector<Reading> readings_{2};
};

}  // namespace softgrip::drivers::test
