// Tests the driver with the server of libmodbus, a widely used Modbus library.

#include <gtest/gtest.h>
#include <modbus/modbus.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <thread>

#include "drivers/modbus/modbus_board.h"
#include "rig/board_map_file.h"
#include "tests/drivers/modbus/on_tcp.h"
#include "tests/drivers/modbus/two_fingers.h"

namespace softgrip::drivers::libmodbus_test {
namespace {

using namespace std::chrono_literals;

/// Serves one session after another until the destructor is called.
class LibmodbusServer {
 public:
  LibmodbusServer()
      : context_(::modbus_new_tcp("127.0.0.1", 0)), mapping_(::modbus_mapping_new(64, 64, 512, 64)) {
    ::modbus_set_slave(context_, 1);
    listener_ = ::modbus_tcp_listen(context_, 4);
    sockaddr_in address{};
    socklen_t size = sizeof address;
    ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { serve(); });
  }
  LibmodbusServer(const LibmodbusServer&) = delete;
  LibmodbusServer& operator=(const LibmodbusServer&) = delete;
  LibmodbusServer(LibmodbusServer&&) = delete;
  LibmodbusServer& operator=(LibmodbusServer&&) = delete;
  ~LibmodbusServer() {
    ::shutdown(listener_, SHUT_RDWR);
    thread_.join();
    ::close(listener_);
    ::modbus_mapping_free(mapping_);
    ::modbus_free(context_);
  }

  [[nodiscard]] std::uint16_t port() const { return port_; }
  /// Returns the registers of the server. A test may use them only between exchanges, when the server waits
  /// for a request.
  [[nodiscard]] modbus_mapping_t& mapping() { return *mapping_; }

 private:
  void serve() {
    std::array<std::uint8_t, MODBUS_TCP_MAX_ADU_LENGTH> request{};
    while (::modbus_tcp_accept(context_, &listener_) >= 0) {
      while (true) {
        const int size = ::modbus_receive(context_, request.data());
        if (size < 0) break;
        ::modbus_reply(context_, request.data(), size, mapping_);
      }
      ::modbus_close(context_);
    }
  }

  modbus_t* context_;
  modbus_mapping_t* mapping_;
  int listener_ = -1;
  std::uint16_t port_ = 0;
  std::thread thread_;
};

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
