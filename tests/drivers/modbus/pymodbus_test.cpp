// Tests the driver with pymodbus, an independent Modbus server. The server has the registers of an ADAM-6024.
// The test compares these registers with the values that the driver writes and reads.

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <csignal>
#include <nlohmann/json.hpp>
#include <string>

#include "drivers/modbus/modbus_board.h"
#include "rig/board_map_file.h"
#include "tests/drivers/modbus/on_tcp.h"
#include "tests/drivers/modbus/two_fingers.h"

namespace softgrip::drivers::pymodbus_test {
namespace {

using namespace std::chrono_literals;
using Json = nlohmann::json;

constexpr auto generous = 10s;

/// A Python process that runs the pymodbus server. The test exchanges lines of JSON with this process.
class PymodbusBoard {
 public:
  /// Starts the server. `how` is nullptr for a TCP server, and "serial" for a serial server.
  explicit PymodbusBoard(const char* how = nullptr) {
    std::array<int, 2> to{};
    std::array<int, 2> from{};
    if (::pipe(to.data()) != 0 || ::pipe(from.data()) != 0) return;
    child_ = ::fork();
    if (child_ == 0) {
      ::dup2(to[0], STDIN_FILENO);
      ::dup2(from[1], STDOUT_FILENO);
      for (const int end : {to[0], to[1], from[0], from[1]}) ::close(end);
      const char* const script = SOFTGRIP_SOURCE_DIR "/tests/drivers/pymodbus_board.py";
      ::execl("/usr/bin/python3", "python3", script, how, nullptr);
      ::_exit(127);
    }
    ::close(to[0]);
    ::close(from[1]);
    write_ = to[1];
    read_ = from[0];
    const Json told = line();
    port_ = told.value("port", std::uint16_t{0});
    device_ = told.value("device", "");
  }
  PymodbusBoard(const PymodbusBoard&) = delete;
  PymodbusBoard& operator=(const PymodbusBoard&) = delete;
  PymodbusBoard(PymodbusBoard&&) = delete;
  PymodbusBoard& operator=(PymodbusBoard&&) = delete;
  ~PymodbusBoard() {
    kill();
    ::close(read_);
    ::close(write_);
  }

  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] const std::string& device() const { return device_; }

  Json ask(const Json& request) {
    const std::string text = request.dump() + "\n";
    if (::write(write_, text.data(), text.size()) != static_cast<ssize_t>(text.size())) return Json::object();
    return line();
  }
  void set(const std::string& table, int address, const std::vector<int>& values) {
    ask({{"set", {table, address, values}}});
  }
  /// Returns the table, the address and the values of every write that the server has received since the last
  /// call.
  Json writes() { return ask({{"writes", true}})["writes"]; }

  void kill() {
    if (child_ <= 0) return;
    ::kill(child_, SIGKILL);
    ::waitpid(child_, nullptr, 0);
    child_ = -1;
  }

 private:
  Json line() {
    const auto end = std::chrono::steady_clock::now() + 60s;
    while (buffer_.find('\n') == std::string::npos) {
      pollfd waiting{read_, POLLIN, 0};
      std::array<char, 4096> chunk{};
      if (std::chrono::steady_clock::now() > end) return Json::object();
      if (::poll(&waiting, 1, 1000) <= 0) continue;
      const ssize_t got = ::read(read_, chunk.data(), chunk.size());
      if (got <= 0) return Json::object();
      buffer_.append(chunk.data(), static_cast<std::size_t>(got));
    }
    const std::size_t size = buffer_.find('\n');
    const Json json = Json::parse(buffer_.substr(0, size), nullptr, false);
    buffer_.erase(0, size + 1);
    return json;
  }

  pid_t child_ = -1;
  int write_ = -1;
  int read_ = -1;
  std::uint16_t port_ = 0;
  std::string device_;
  std::string buffer_;
};

int adam_raw(double volt) {
  return static_cast<int>(std::lround((volt + 10) / 20 * 65535));
}

class PymodbusTest : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_NE(server_.port(), 0)
        << "check if python3-pymodbus, python3-serial and python3-serial-asyncio are installed";
    document::Problems problems;
    const auto map = rig::load_board_map(SOFTGRIP_SOURCE_DIR "/config/boards/adam-6024.yaml", problems);
    ASSERT_TRUE(map.has_value()) << problems.format();
    settings_ = test::on_tcp(server_.port(), *map, test::two_fingers());
    server_.set("input", 0, std::vector<int>(6, adam_raw(5)));
  }

  PymodbusBoard server_;
  ModbusSettings settings_;
  std::array<Reading, 2> readings_;
};

TEST_F(PymodbusTest, AdamRegistersAreWrittenAndRead) {
  settings_.modules[0].map.read_back.reset();  // an ADAM shows its outputs in input registers; pymodbus does
                                               // not copy them there
  ModbusBoard board(settings_);
  ASSERT_EQ(board.connect(generous), BusStatus::ok) << board.detail();
  EXPECT_EQ(server_.writes(), Json::array()) << "connecting writes nothing";

  server_.set("input", 0, {adam_raw(3), adam_raw(7), 0, 0, adam_raw(2.5), adam_raw(9)});
  ASSERT_EQ(board.exchange(std::array{25.0, 75.0}, readings_, generous), BusStatus::ok) << board.detail();
  // The registers 40011 and 40012 have the addresses 10 and 11. The values are 2.5 V and 7.5 V in steps of 10
  // V / 4095.
  EXPECT_EQ(server_.writes(), (Json{{"holding", 10, {1024, 3071}}}));
  EXPECT_EQ(server_.ask({{"get", {"holding", 9, 4}}})["values"], (Json{0, 1024, 3071, 0}));
  EXPECT_NEAR(readings_[0].displacement_mm, -5 + 3 * 5, 0.001);
  EXPECT_NEAR(readings_[1].displacement_mm, -5 + 7 * 5, 0.001);
  EXPECT_NEAR(readings_[0].pressure_kpa, 25, 0.002);
  EXPECT_NEAR(readings_[1].pressure_kpa, 90, 0.002);

  server_.set("input", 20, {1, 0});
  ASSERT_EQ(board.exchange(std::array{25.0, 75.0}, readings_, generous), BusStatus::ok) << board.detail();
  EXPECT_EQ(readings_[0].validity, model::Validity::out_of_range);
  EXPECT_EQ(readings_[1].validity, model::Validity::valid);
}

TEST_F(PymodbusTest, TransmitsRawOutputValuesExactly) {
  settings_.modules[0].map.read_back.reset();
  ModbusBoard board(settings_);
  ASSERT_EQ(board.connect(generous), BusStatus::ok) << board.detail();
  for (int raw = 0; raw <= 4095; raw += 91) {
    const double kpa = raw * 100.0 / 4095;
    ASSERT_EQ(board.exchange(std::array{kpa, 100 - kpa}, readings_, generous), BusStatus::ok)
        << board.detail();
    ASSERT_EQ(server_.ask({{"get", {"holding", 10, 2}}})["values"], (Json{raw, 4095 - raw}));
  }
}

TEST_F(PymodbusTest, ReportsADifferingReadBack) {
  ModbusBoard board(settings_);
  ASSERT_EQ(board.connect(generous), BusStatus::ok) << board.detail();
  server_.set("input", 10, {1024, 3071});
  EXPECT_EQ(board.exchange(std::array{25.0, 75.0}, readings_, generous), BusStatus::ok) << board.detail();
  EXPECT_NEAR(readings_[0].command_readback_kpa, 25, 0.0123);
  server_.set("input", 10, {1024, 3069});
  EXPECT_EQ(board.exchange(std::array{25.0, 75.0}, readings_, generous), BusStatus::write_refused);
}

TEST_F(PymodbusTest, ExchangesWithFunction23) {
  document::Problems problems;
  const auto map = rig::load_board_map(SOFTGRIP_SOURCE_DIR "/config/boards/softgrip-sim.yaml", problems);
  ASSERT_TRUE(map.has_value()) << problems.format();
  settings_.modules[0].map = *map;
  settings_.modules[0].map.read_back.reset();
  ModbusBoard board(settings_);
  server_.set("holding", 0, {0x40a0, 0, 0x40c0, 0, 0, 0, 0, 0, 0x3f80, 0, 0x4000, 0});
  ASSERT_EQ(board.connect(generous), BusStatus::ok) << board.detail();
  EXPECT_EQ(server_.writes(), (Json{{"holding", 265, {200}}}))
      << "the board must receive the setup writes of the board map";
  ASSERT_EQ(board.exchange(std::array{12.5, 50.0}, readings_, generous), BusStatus::ok) << board.detail();
  EXPECT_EQ(server_.writes(), (Json{{"holding", 256, {0x3fa0, 0, 0x40a0, 0}}}));
  EXPECT_DOUBLE_EQ(readings_[0].displacement_mm, 20);
  EXPECT_DOUBLE_EQ(readings_[1].displacement_mm, 25);
  EXPECT_DOUBLE_EQ(readings_[0].pressure_kpa, 10);
}

TEST_F(PymodbusTest, ReportsAnExceptionForAnInvalidAddress) {
  settings_.modules[0].map.inputs.registers.address = 65533;
  ModbusBoard board(settings_);
  EXPECT_EQ(board.connect(generous), BusStatus::exception);
  EXPECT_NE(std::string(board.detail()).find("data address"), std::string::npos) << board.detail();
}

TEST_F(PymodbusTest, AnotherUnitIdTimesOut) {
  settings_.modules[0].unit = 9;
  ModbusBoard board(settings_);
  EXPECT_EQ(board.connect(300ms), BusStatus::timed_out);
}

TEST_F(PymodbusTest, ReportsAServerThatTerminates) {
  settings_.modules[0].map.read_back.reset();
  ModbusBoard board(settings_);
  ASSERT_EQ(board.connect(generous), BusStatus::ok) << board.detail();
  ASSERT_EQ(board.exchange(std::array{25.0, 75.0}, readings_, generous), BusStatus::ok);
  server_.kill();
  EXPECT_EQ(board.exchange(std::array{25.0, 75.0}, readings_, generous), BusStatus::disconnected);
  EXPECT_EQ(board.connect(1s), BusStatus::disconnected);
}

/// Tests two modules on one serial line, both simulated by pymodbus.
TEST(PymodbusOnALine, TwoModulesAreWrittenAndRead) {
  PymodbusBoard server("serial");
  ASSERT_NE(server.device(), "");
  ModbusSettings settings;
  SerialLine line;
  line.device = server.device();
  line.baud = 115200;
  settings.links.emplace_back(line);
  for (const std::string name : {"waveshare-ao8-b", "waveshare-ai8-b"}) {
    document::Problems problems;
    const auto map = rig::load_board_map(SOFTGRIP_SOURCE_DIR "/config/boards/" + name + ".yaml", problems);
    ASSERT_TRUE(map.has_value()) << problems.format();
    settings.modules.push_back({name, *map, static_cast<std::uint8_t>(1 + settings.modules.size()), 0});
  }
  settings.wiring = test::two_fingers();
  for (ChannelWiring& channel : settings.wiring) {
    channel.displacement.module = 1;
    channel.pressure->module = 1;
  }
  server.set("input", 0, {3000, 7000, 0, 0, 2500, 9000});
  ModbusBoard board(settings);
  ASSERT_EQ(board.connect(generous), BusStatus::ok) << board.detail();
  EXPECT_EQ(server.writes(), Json::array()) << "connecting writes nothing";
  std::array<Reading, 2> readings;
  for (int i = 0; i <= 100; i += 4) {
    ASSERT_EQ(board.exchange(std::array{1.0 * i, 100.0 - i}, readings, generous), BusStatus::ok)
        << board.detail();
    ASSERT_EQ(server.writes(), (Json{{"holding", 0, {100 * i, 10000 - 100 * i}}}));
  }
  EXPECT_DOUBLE_EQ(readings[0].displacement_mm, 10);
  EXPECT_DOUBLE_EQ(readings[1].displacement_mm, 30);
  EXPECT_DOUBLE_EQ(readings[1].pressure_kpa, 90);
  EXPECT_DOUBLE_EQ(readings[0].command_readback_kpa, 100);

  settings.modules[1].unit = 3;
  ModbusBoard second_client(settings);
  EXPECT_EQ(second_client.connect(500ms), BusStatus::disconnected)
      << "a serial line can have only one Modbus client";
}

TEST(PymodbusOnALine, AMissingUnitTimesOutAndReleasesTheLine) {
  PymodbusBoard server("serial");
  SerialLine line;
  line.device = server.device();
  line.baud = 115200;
  document::Problems problems;
  auto map = rig::load_board_map(SOFTGRIP_SOURCE_DIR "/config/boards/softgrip-sim.yaml", problems);
  ASSERT_TRUE(map.has_value());
  map->setup.clear();
  map->read_back.reset();
  ModbusSettings settings{
      .links = {line}, .modules = {{.name = "sim", .map = *map, .unit = 9}}, .wiring = test::two_fingers()};
  ModbusBoard board(settings);
  EXPECT_EQ(board.connect(500ms), BusStatus::timed_out) << board.detail();
  settings.modules[0].unit = 1;
  ModbusBoard there(settings);
  ASSERT_EQ(board.connect(1ms), BusStatus::timed_out) << "the failed connection must release the serial line";
  ASSERT_EQ(there.connect(generous), BusStatus::ok) << there.detail();
  std::array<Reading, 2> readings;
  ASSERT_EQ(there.exchange(std::array{12.5, 50.0}, readings, generous), BusStatus::ok) << there.detail();
  EXPECT_EQ(server.writes(), (Json{{"holding", 256, {0x3fa0, 0, 0x40a0, 0}}}))
      << "function code 23 on a serial line";
}

}  // namespace
}  // namespace softgrip::drivers::pymodbus_test
