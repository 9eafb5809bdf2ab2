// Tests the driver with the server of libmodbus, a widely used Modbus library.

#include <gtest/gtest.h>

#include <array>

#include "drivers/modbus/modbus_board.h"
#include "rig/board_map_file.h"
#include "tests/drivers/modbus/libmodbus_server.h"
#include "tests/drivers/modbus/on_tcp.h"
#include "tests/drivers/modbus/two_fingers.h"

namespace softgrip::drivers::libmodbus_test {
namespace {

using namespace std::chrono_literals;
using test::LibmodbusServer;

BoardMap shipped(const std::string& name) {
  document::Problems problems;
  return rig::load_board_map(SOFTGRIP_SOURCE_DIR "/config/boards/" + name, problems).value();
}

TEST(Libmodbus, ExchangesWithFunctions16And4) {
  LibmodbusServer server;
  for (int i = 0; i < 6; ++i)
    server.mapping().tab_input_registers[i] = 49151;  // 5 V, as a raw value of 16
                                                      // bits
  ModbusSettings settings = test::on_tcp(server.port(), shipped("adam-6024.yaml"), test::two_fingers());
  BoardMap& map = settings.modules[0].map;
  map.read_back.reset();
  {
    ModbusBoard board(settings);
    ASSERT_EQ(board.connect(5s), BusStatus::ok) << board.detail();
    std::array<Reading, 2> readings;
    for (int i = 0; i < 200; ++i) {
      ASSERT_EQ(board.exchange(std::array{0.5 * i, 100 - 0.5 * i}, readings, 5s), BusStatus::ok)
          << board.detail();
    }
    EXPECT_EQ(server.mapping().tab_registers[10], 4075);  // 99.5 kPa, as a raw value of 12 bits
    EXPECT_EQ(server.mapping().tab_registers[11], 20);    // 0.5 kPa, as a raw value of 12 bits
    EXPECT_NEAR(readings[0].displacement_mm, 20, 0.001);
    EXPECT_NEAR(readings[1].pressure_kpa, 50, 0.002);
  }
}

TEST(Libmodbus, ExchangesWithFunction23AndReportsAnException) {
  LibmodbusServer server;
  ModbusSettings settings =
      test::on_tcp(server.port(), shipped("softgrip-sim.yaml"), test::two_fingers(false));
  BoardMap& map = settings.modules[0].map;
  map.read_back.reset();
  server.mapping().tab_registers[0] = 0x40a0;  // 5 V as a float; this register holds the upper half
  server.mapping().tab_registers[2] = 0x4000;  // 2 V as a float; this register holds the upper half
  {
    ModbusBoard board(settings);
    ASSERT_EQ(board.connect(5s), BusStatus::ok) << board.detail();
    std::array<Reading, 2> readings;
    ASSERT_EQ(board.exchange(std::array{12.5, 50.0}, readings, 5s), BusStatus::ok) << board.detail();
    EXPECT_EQ(server.mapping().tab_registers[256], 0x3fa0);
    EXPECT_EQ(server.mapping().tab_registers[258], 0x40a0);
    EXPECT_DOUBLE_EQ(readings[0].displacement_mm, 20);
    EXPECT_DOUBLE_EQ(readings[1].displacement_mm, 5);
  }
  map.outputs.registers.address = 511;
  {
    ModbusBoard board(settings);
    ASSERT_EQ(board.connect(5s), BusStatus::ok) << board.detail();
    std::array<Reading, 2> readings;
    EXPECT_EQ(board.exchange(std::array{12.5, 50.0}, readings, 5s), BusStatus::exception) << board.detail();
  }
}

}  // namespace
}  // namespace softgrip::drivers::libmodbus_test
