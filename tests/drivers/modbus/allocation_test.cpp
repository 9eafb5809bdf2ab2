// Tests that exchange() never allocates memory, neither in a successful nor in a failed exchange. The test
// counts the calls of operator new. Without a sanitizer, it also counts the calls of malloc().

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "drivers/modbus/modbus_board.h"
#include "model/file/model_file.h"
#include "rig/board_map_file.h"
#include "simulation/plant/simulated_board.h"
#include "tests/drivers/modbus/on_tcp.h"
#include "tests/drivers/modbus/register_server.h"
#include "tests/drivers/modbus/two_fingers.h"
#include "tests/support/allocation_counter.h"

namespace softgrip::drivers::allocation_test {
namespace {

using namespace std::chrono_literals;
using namespace simulation;
using namespace rig;
using softgrip::test::allocations_of;
using test::RegisterServer;

TEST(Allocation, TheCounterDetectsAnAllocation) {
  static std::vector<std::string> kept;  // static, so that the compiler must keep the allocation
  EXPECT_GT(allocations_of([] { kept.emplace_back(100, 'x'); }), 0U);
  EXPECT_EQ(allocations_of([] {}), 0U);
}

class ModbusAllocation : public testing::Test {
 protected:
  ModbusAllocation() {
    document::Problems problems;
    const auto map = load_board_map(SOFTGRIP_SOURCE_DIR "/config/boards/adam-6024.yaml", problems);
    settings_ = test::on_tcp(server_.port(), *map, test::two_fingers());
    server_.on_request([](RegisterServer& server, const RegisterServer::Request&) {
      server.input_[10] = server.holding_[10];
      server.input_[11] = server.holding_[11];
    });
  }

  /// Performs one exchange. The exchange must return `expected` and must not allocate memory.
  void expect(BusStatus expected, std::array<double, 2> commands, std::chrono::nanoseconds deadline = 5s) {
    BusStatus status = BusStatus::ok;
    const std::size_t made =
        allocations_of([&] { status = board_->exchange(commands, readings_, deadline); });
    EXPECT_EQ(status, expected) << board_->detail();
    EXPECT_EQ(made, 0U) << name_of(status);
  }

  void connect() {
    board_ = std::make_unique<ModbusBoard>(settings_);
    ASSERT_EQ(board_->connect(5s), BusStatus::ok) << board_->detail();
  }

  RegisterServer server_;
  ModbusSettings settings_;
  std::unique_ptr<ModbusBoard> board_;
  std::array<Reading, 2> readings_;
};

TEST_F(ModbusAllocation, SuccessfulExchangesAllocateNoMemory) {
  connect();
  for (int i = 0; i < 50; ++i) expect(BusStatus::ok, {1.0 * i, 2.0 * i});
}

TEST_F(ModbusAllocation, FailedExchangesAllocateNoMemory) {
  connect();
  expect(BusStatus::write_refused, {10, 1234.5678});
  expect(BusStatus::write_refused, {10, std::numeric_limits<double>::quiet_NaN()});
  server_.ignore_writes(true);
  expect(BusStatus::ok, {90, 90});  // the board map allows the read-back to lag by one exchange
  expect(BusStatus::write_refused, {90, 90});
  server_.ignore_writes(false);
  for (const std::uint8_t code : {std::uint8_t{2}, std::uint8_t{9}, std::uint8_t{200}}) {
    server_.refuse(std::uint8_t{16}, code);
    expect(BusStatus::exception, {10, 10});
  }
  server_.refuse(std::nullopt);
  server_.delay(200ms);
  expect(BusStatus::timed_out, {10, 10}, 20ms);
  expect(BusStatus::disconnected, {10, 10});
}

TEST_F(ModbusAllocation, MalformedResponsesCauseNoAllocation) {
  int kind = 0;
  test::ScriptedServer hostile([&kind](test::Peer& peer, const test::Bytes& request, std::size_t) {
    test::Bytes reply = test::frame_for(request, {request.at(7), 0, 10, 0, 2});
    if (kind == 0) reply[6] ^= 1;
    if (kind == 1) reply[1] ^= 1;
    if (kind == 2) reply.resize(5000);
    if (kind == 3) return peer.reset();
    peer.send(reply);
  });
  settings_.links = {TcpAddress{"127.0.0.1", hostile.port()}};
  settings_.probes = 0;
  for (kind = 0; kind < 4; ++kind) {
    connect();
    expect(kind == 3 ? BusStatus::closed_at_once : BusStatus::bad_reply, {10, 10});
  }
}

TEST_F(ModbusAllocation, AWatchdogTripCausesNoAllocation) {
  BoardWatchdog& watchdog = settings_.modules[0].map.watchdog;
  watchdog.tripped = BoardWatchdog::Tripped{.function = 1, .address = 32, .mask = 1};
  watchdog.clear = {FixedWrite{.function = 5, .address = 32, .value = 0}};
  server_.set_coil(32, 1);
  connect();
  expect(BusStatus::ok, {10, 10});
  server_.set_coil(32, 1);
  expect(BusStatus::watchdog_tripped, {10, 10});
}

TEST(SimulatedAllocation, ExchangesWithEveryEventAllocateNoMemory) {
  document::Problems problems;
  const auto model = model::load_model(SOFTGRIP_SOURCE_DIR "/config/models/bench_twin.yaml", problems);
  ASSERT_TRUE(model.has_value()) << problems.format();
  SimulatedBoardSettings settings;
  for (const char* name : {"left", "right"}) {
    SimulatedChannel channel;
    channel.name = name;
    channel.plant = {.model = *model, .object = std::nullopt, .sample_time_s = 0.005};
    channel.plant.displacement_noise_mm = 0.03;
    channel.measures_pressure = true;
    channel.valve_max_kpa = 100;
    channel.sensor_min_mm = -5;
    channel.sensor_max_mm = 45;
    channel.output_bits = 12;
    channel.input_bits = 16;
    settings.channels.push_back(channel);
  }
  using Kind = SimulatedEvent::Kind;
  settings.events.push_back({.at_s = 1.0013, .kind = Kind::object, .object = PlantObject{5, 0.1}});
  settings.events.push_back({.at_s = 2.001, .kind = Kind::object});
  settings.events.push_back({.at_s = 3, .kind = Kind::line_fault, .line = {LineFault::Kind::leaking, 0.3}});
  settings.events.push_back({.at_s = 4, .kind = Kind::sensor_fault, .sensor = {SensorFault::Kind::stuck, 0}});
  settings.events.push_back({.at_s = 5, .kind = Kind::write_refused});
  settings.events.push_back({.at_s = 6, .kind = Kind::write_taken});
  settings.events.push_back({.at_s = 8, .kind = Kind::bus_lost});
  settings.watchdog_timeout_s = 0.1;
  VirtualClock clock;
  SimulatedBoard board(settings, clock);
  ASSERT_EQ(board.connect(1s), BusStatus::ok);
  std::array<Reading, 2> readings;
  std::array<int, 9> seen{};
  const std::size_t made = allocations_of([&] {
    for (int i = 0; i < 2000; ++i) {
      const std::array commands{30 + 10.0 * (i % 3), i % 500 == 499 ? 101.0 : 20.0};
      ++seen[static_cast<std::size_t>(board.exchange(commands, readings, 1ms))];
      clock.advance(i == 1500 ? 400'000'000 : 5'000'000);
    }
  });
  EXPECT_EQ(made, 0U);
  EXPECT_GT(seen[static_cast<std::size_t>(BusStatus::ok)], 500);
  EXPECT_GT(seen[static_cast<std::size_t>(BusStatus::write_refused)], 10);
  EXPECT_GT(seen[static_cast<std::size_t>(BusStatus::watchdog_tripped)], 10);
  EXPECT_GT(seen[static_cast<std::size_t>(BusStatus::disconnected)], 10);
}

}  // namespace
}  // namespace softgrip::drivers::allocation_test
