// Tests the driver with a Modbus server on real sockets. Checks the registers, the values and the status of
// exchanges.

#include "drivers/modbus/modbus_board.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "base/clock.h"
#include "tests/drivers/modbus/modbus_board_fixture.h"

namespace softgrip::drivers::modbus_board_test {
namespace {

using namespace std::chrono_literals;
using model::Validity;
using test::adam_raw;
using test::generous;
using test::ModbusBoardTest;
using test::RegisterServer;
using test::Requests;
using test::shipped;

TEST_F(ModbusBoardTest, TheAdamMapUsesTheRegistersOfTheManual) {
  connect(shipped("adam-6024.yaml"));
  server_.set_input(0, adam_raw(3));
  server_.set_input(1, adam_raw(7));
  server_.set_input(4, adam_raw(1));
  server_.set_input(5, adam_raw(2));
  ASSERT_EQ(exchange(40, 100), BusStatus::ok) << board_->detail();

  const Requests expected{
      {16, 10, 0, 10, {1638, 4095}}, {4, 0, 6, 0, {}}, {4, 10, 2, 0, {}}, {4, 20, 6, 0, {}}};
  EXPECT_EQ(server_.take_requests(), expected);
  // Half a step of the converter is 0.15 mV for 16 bits over 20 V, and 1.2 mV for 12 bits over 10 V. The
  // scales are 5 mm/V and 10 kPa/V.
  EXPECT_NEAR(readings_[0].displacement_mm, 10, 0.001);
  EXPECT_NEAR(readings_[1].displacement_mm, 30, 0.001);
  EXPECT_NEAR(readings_[0].pressure_kpa, 10, 0.002);
  EXPECT_NEAR(readings_[1].pressure_kpa, 20, 0.002);
  EXPECT_NEAR(readings_[0].command_readback_kpa, 40, 0.0123);
  EXPECT_NEAR(readings_[1].command_readback_kpa, 100, 1e-9);
  for (const Reading& reading : readings_) {
    EXPECT_EQ(reading.validity, Validity::valid);
    EXPECT_EQ(reading.sequence, 1U);
  }
}

TEST_F(ModbusBoardTest, AllChannelsShareATemperatureInput) {
  wiring_ = test::two_fingers_and_a_thermometer();
  connect(shipped("adam-6024.yaml"));
  server_.set_input(2, adam_raw(2.4));
  ASSERT_EQ(exchange(0, 0), BusStatus::ok) << board_->detail();
  for (const Reading& reading : readings_) EXPECT_NEAR(reading.temperature_c, 24, 0.01);
  server_.set_input(2, adam_raw(0));
  ASSERT_EQ(exchange(0, 0), BusStatus::ok);
  for (const Reading& reading : readings_) EXPECT_TRUE(std::isnan(reading.temperature_c));
}

TEST_F(ModbusBoardTest, TheTimestampLiesWithinTheExchange) {
  connect(shipped("adam-6024.yaml"));
  const Nanoseconds before = MonotonicClock().now();
  ASSERT_EQ(exchange(0, 0), BusStatus::ok);
  const Nanoseconds after = MonotonicClock().now();
  EXPECT_GE(readings_[0].sampled_at, before);
  EXPECT_LE(readings_[0].sampled_at, after);
  EXPECT_EQ(readings_[0].sampled_at, readings_[1].sampled_at);
  const Nanoseconds first = readings_[0].sampled_at;
  ASSERT_EQ(exchange(0, 0), BusStatus::ok);
  EXPECT_GT(readings_[0].sampled_at, first);
  EXPECT_EQ(readings_[0].sequence, 2U);
}

TEST_F(ModbusBoardTest, Function23NeedsOneTransaction) {
  wiring_ = test::two_fingers(false);
  connect(shipped("softgrip-sim.yaml"));
  const auto put = [this](std::uint16_t address, float volt) {
    const auto bits = std::bit_cast<std::uint32_t>(volt);
    server_.set_holding(address, static_cast<std::uint16_t>(bits >> 16));
    server_.set_holding(static_cast<std::uint16_t>(address + 1), static_cast<std::uint16_t>(bits & 0xffff));
  };
  put(0, 3.5F);
  put(2, 6.25F);
  server_.on_request([](RegisterServer& server, const RegisterServer::Request& request) {
    for (std::size_t i = 0; i < request.written.size(); ++i) {
      server.holding_[static_cast<std::uint16_t>(24 + i)] = request.written[i];
    }
  });
  ASSERT_EQ(exchange(12.5, 50), BusStatus::ok) << board_->detail();
  const Requests requests = server_.take_requests();
  // In the first exchange of a session, a second request reads if the watchdog has tripped.
  ASSERT_EQ(requests.size(), 2U);
  EXPECT_EQ(requests[0].function, 23);
  EXPECT_EQ(requests[0].write_address, 256);
  EXPECT_EQ(requests[0].written, (std::vector<std::uint16_t>{0x3fa0, 0, 0x40a0, 0}));  // 1.25 V and 5 V as
                                                                                       // floats
  EXPECT_DOUBLE_EQ(readings_[0].displacement_mm, 12.5);
  EXPECT_DOUBLE_EQ(readings_[1].displacement_mm, 26.25);
  EXPECT_DOUBLE_EQ(readings_[1].command_readback_kpa, 50);
  ASSERT_EQ(exchange(12.5, 50), BusStatus::ok) << board_->detail();
  EXPECT_EQ(server_.take_requests().size(), 1U);
}

TEST_F(ModbusBoardTest, DecodesFloatsWithTheLowWordFirst) {
  wiring_ = test::two_fingers(false);
  BoardMap map = shipped("softgrip-sim.yaml");
  map.word_order = WordOrder::low_first;
  map.read_back.reset();
  connect(map);
  server_.set_holding(0, 0x0000);
  server_.set_holding(1, 0x4060);  // 3.5 V as a float; this register holds the upper half
  server_.set_holding(3, 0x4060);
  ASSERT_EQ(exchange(12.5, 0), BusStatus::ok) << board_->detail();
  EXPECT_DOUBLE_EQ(readings_[0].displacement_mm, 12.5);
  EXPECT_EQ(server_.holding(256), 0);
  EXPECT_EQ(server_.holding(257), 0x3fa0);
}

// On a bipolar board, the raw value 0 means -10 V. Therefore the driver must never write to an output that is
// not wired.
TEST_F(ModbusBoardTest, OnlyWiredOutputsAreWritten) {
  BoardMap map = shipped("softgrip-sim.yaml");
  map.has_fc23 = false;
  map.read_back.reset();
  map.watchdog = {};
  map.setup.clear();
  wiring_ = test::two_fingers(false);
  wiring_[0].valve.output = 0;
  wiring_[1].valve.output = 3;
  connect(map);
  server_.set_holding(0, 0x40a0);
  server_.set_holding(2, 0x40a0);
  ASSERT_EQ(exchange(10, 20), BusStatus::ok) << board_->detail();
  for (const auto& request : server_.take_requests()) {
    if (request.written.empty()) continue;
    EXPECT_EQ(request.written.size(), 2U);
    EXPECT_TRUE(request.write_address == 256 || request.write_address == 262) << request.write_address;
  }
}

/// Returns a map whose outputs are floats that the board reports exactly, without a tolerance.
BoardMap exact_floats() {
  BoardMap map = shipped("softgrip-sim.yaml");
  map.has_fc23 = false;
  map.watchdog = {};
  map.setup.clear();
  map.read_back->registers.address = map.outputs.registers.address;
  map.read_back->tolerance_raw = 0;
  map.read_back->lag_exchanges = 0;
  return map;
}

TEST_F(ModbusBoardTest, AFloatOutputIsConfirmedWithoutATolerance) {
  wiring_ = test::two_fingers(false);
  connect(exact_floats());
  for (int i = 0; i < 40; ++i) ASSERT_EQ(exchange(33.3 + i, 0.1 * i), BusStatus::ok) << board_->detail();
  server_.ignore_writes(true);
  EXPECT_EQ(exchange(10, 10), BusStatus::write_refused);
}

TEST_F(ModbusBoardTest, AFloatOutputAcceptsTheFullScaleDespiteARoundingError) {
  wiring_ = test::two_fingers(false);
  for (const double full_kpa : {147.0, 281.0, 525.0}) {
    for (ChannelWiring& channel : wiring_) channel.valve.scaling = {0, 0, 10, full_kpa};
    ASSERT_GT(wiring_[0].valve.scaling.x_at(full_kpa), 10);
    connect(exact_floats());
    EXPECT_EQ(exchange(full_kpa, 0), BusStatus::ok) << board_->detail();
    EXPECT_EQ(exchange(full_kpa * (1 + 1e-6), 0), BusStatus::write_refused);
  }
}

TEST_F(ModbusBoardTest, ChannelsMayBeWiredInAnyOrder) {
  std::swap(wiring_[0].valve.output, wiring_[1].valve.output);
  std::swap(wiring_[0].displacement.input, wiring_[1].displacement.input);
  connect(shipped("adam-6024.yaml"));
  server_.set_input(0, adam_raw(3));
  server_.set_input(1, adam_raw(7));
  ASSERT_EQ(exchange(40, 100), BusStatus::ok) << board_->detail();
  EXPECT_EQ(server_.holding(10), 4095);
  EXPECT_EQ(server_.holding(11), 1638);
  EXPECT_NEAR(readings_[0].displacement_mm, 30, 0.001);
  EXPECT_NEAR(readings_[1].displacement_mm, 10, 0.001);
}

TEST_F(ModbusBoardTest, DeterminesValidityBySignalErrorCodeAndStatus) {
  connect(shipped("adam-6024.yaml"));
  server_.set_input(0, adam_raw(0.05));  // 0.05 V is below the valid electrical range of the sensor
  server_.set_input(1, adam_raw(9.95));  // 9.95 V is the error code of the sensor
  ASSERT_EQ(exchange(0, 0), BusStatus::ok);
  EXPECT_EQ(readings_[0].validity, Validity::out_of_range);
  EXPECT_EQ(readings_[1].validity, Validity::sensor_error);
  server_.set_input(0, adam_raw(5));
  server_.set_input(1, adam_raw(5));
  server_.set_input(20, 1);  // status of the sensor input: above its range
  server_.set_input(21, 7);  // status of the sensor input: a value that is not in the manual
  server_.set_input(24, 2);  // status of the left pressure input: below its range
  ASSERT_EQ(exchange(0, 0), BusStatus::ok);
  EXPECT_EQ(readings_[0].validity, Validity::out_of_range);
  EXPECT_EQ(readings_[1].validity, Validity::sensor_error);
  EXPECT_TRUE(std::isnan(readings_[0].pressure_kpa));
  EXPECT_FALSE(std::isnan(readings_[1].pressure_kpa));
}

TEST_F(ModbusBoardTest, ACommandOutsideTheRangeIsLimitedAndReported) {
  connect(shipped("adam-6024.yaml"));
  ASSERT_EQ(exchange(10, 10), BusStatus::ok);
  EXPECT_EQ(exchange(10, 101), BusStatus::write_refused);
  EXPECT_NE(std::string(board_->detail()).find("right"), std::string::npos) << board_->detail();
  EXPECT_EQ(server_.holding(11), 4095);
  EXPECT_EQ(exchange(-1, 10), BusStatus::write_refused);
  EXPECT_EQ(server_.holding(10), 0);
  EXPECT_EQ(readings_[0].sequence, 1U) << "readings change only if the status is ok";
  EXPECT_EQ(exchange(100, 0), BusStatus::ok)
      << "a command that equals a limit is permitted: " << board_->detail();
}

TEST_F(ModbusBoardTest, ANonFiniteCommandWritesNothing) {
  connect(shipped("adam-6024.yaml"));
  ASSERT_EQ(exchange(10, 20), BusStatus::ok);
  (void)server_.take_requests();
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(exchange(bad, 50), BusStatus::write_refused);
    EXPECT_EQ(exchange(50, bad), BusStatus::write_refused);
  }
  EXPECT_TRUE(server_.take_requests().empty());
}

TEST_F(ModbusBoardTest, AnExceptionIsReportedWithoutEndingTheSession) {
  connect(shipped("adam-6024.yaml"));
  for (const std::uint8_t function : {std::uint8_t{16}, std::uint8_t{4}}) {
    server_.refuse(function, 2);
    EXPECT_EQ(exchange(10, 10), BusStatus::exception);
    EXPECT_NE(std::string(board_->detail()).find("function " + std::to_string(function)), std::string::npos)
        << board_->detail();
    EXPECT_EQ(readings_[0].sequence, 0U);
    server_.refuse(std::nullopt);
  }
  EXPECT_EQ(exchange(10, 10), BusStatus::ok);
  EXPECT_EQ(server_.sessions(), 1U);
}

TEST_F(ModbusBoardTest, TheDeadlineSpansTheWholeExchange) {
  connect(shipped("adam-6024.yaml"));
  server_.delay(30ms);  // each of the 4 responses alone is in time, but the sum of the 4 delays exceeds the
                        // deadline
  const Nanoseconds before = MonotonicClock().now();
  EXPECT_EQ(exchange(10, 10, 50ms), BusStatus::timed_out);
  EXPECT_LT(MonotonicClock().now() - before, 50'000'000 + 400'000'000);
  EXPECT_EQ(exchange(10, 10), BusStatus::disconnected);
  EXPECT_NE(std::string(board_->detail()).find("deadline"), std::string::npos)
      << "the message must still state why the connection was lost: " << board_->detail();
  EXPECT_EQ(readings_[0].sequence, 0U);
  server_.delay(0ms);
  ASSERT_EQ(board_->connect(generous), BusStatus::ok) << board_->detail();
  EXPECT_EQ(exchange(10, 10), BusStatus::ok);
}

TEST_F(ModbusBoardTest, WithoutASessionNothingIsSent) {
  board_ = std::make_unique<ModbusBoard>(settings(shipped("adam-6024.yaml")));
  EXPECT_EQ(exchange(10, 10), BusStatus::disconnected);
  EXPECT_EQ(server_.sessions(), 0U);
}

TEST_F(ModbusBoardTest, SetupIsWrittenInOrderOnEveryConnect) {
  BoardMap map = shipped("adam-6024.yaml");
  map.setup = {{6, 500, 7}, {16, 501, 8}, {5, 3, 1}};
  board_ = std::make_unique<ModbusBoard>(settings(map));
  const Requests expected{{6, 500, 0, 500, {7}}, {16, 501, 0, 501, {8}}, {5, 3, 0, 3, {0xff00}}};
  for (int i = 0; i < 2; ++i) {
    ASSERT_EQ(board_->connect(generous), BusStatus::ok) << board_->detail();
    EXPECT_EQ(server_.take_requests(), expected);
  }
  server_.refuse(6, 3);
  EXPECT_EQ(board_->connect(generous), BusStatus::exception);
  EXPECT_EQ(exchange(0, 0), BusStatus::disconnected) << "a board that refuses its setup is not used";
}

TEST_F(ModbusBoardTest, ConnectingWritesNoOutput) {
  ModbusSettings with_probes = settings(shipped("adam-6024.yaml"));
  with_probes.probes = 3;
  board_ = std::make_unique<ModbusBoard>(with_probes);
  EXPECT_NE(board_->budget().explanation.find("assumed"), std::string::npos);
  ASSERT_EQ(board_->connect(generous), BusStatus::ok);
  const Requests expected(3, {4, 0, 6, 0, {}});
  EXPECT_EQ(server_.take_requests(), expected);
  const Board::Budget budget = board_->budget();
  EXPECT_NE(budget.explanation.find("4 round trips"), std::string::npos) << budget.explanation;
  EXPECT_NE(budget.explanation.find("median of 3 round trips"), std::string::npos) << budget.explanation;
  EXPECT_GT(budget.exchange_s, 0);
}

TEST_F(ModbusBoardTest, LaterSessionsWriteTheOutputsFirst) {
  ModbusSettings with_probes = settings(shipped("adam-6024.yaml"));
  with_probes.probes = 3;
  board_ = std::make_unique<ModbusBoard>(with_probes);
  ASSERT_EQ(board_->connect(generous), BusStatus::ok);
  (void)server_.take_requests();
  ASSERT_EQ(board_->connect(generous), BusStatus::ok);
  EXPECT_TRUE(server_.take_requests().empty())
      << "a request during the connection would reset the watchdog before the outputs are safe";
  ASSERT_EQ(exchange(0, 0), BusStatus::ok);
  EXPECT_EQ(server_.take_requests().front().function, 16);
}

TEST_F(ModbusBoardTest, DescribesModelAddressAndUnit) {
  board_ = std::make_unique<ModbusBoard>(settings(shipped("adam-6024.yaml")));
  EXPECT_EQ(board_->describe(), "ADAM-6024 at 127.0.0.1:" + std::to_string(server_.port()) + " unit 1");
  EXPECT_TRUE(board_->has_watchdog());
  EXPECT_EQ(board_->channels(), 2U);
}

TEST_F(ModbusBoardTest, AWrongNumberOfChannelsIsRefused) {
  connect(shipped("adam-6024.yaml"));
  const std::vector<double> one{1};
  EXPECT_EQ(board_->exchange(one, readings_, generous), BusStatus::write_refused);
  EXPECT_TRUE(server_.take_requests().empty());
}

TEST_F(ModbusBoardTest, ReportsTheClientCountOfTheBoard) {
  BoardMap map = shipped("adam-6024.yaml");
  connect(map);
  ASSERT_EQ(exchange(10, 10), BusStatus::ok) << board_->detail();
  EXPECT_EQ(board_->clients(), 0U) << "this board does not count clients";
  EXPECT_TRUE(board_->fed_by_readers());
  map.watchdog.clients = BoardWatchdog::ClientCount{.function = 4, .address = 30};
  server_.set_input(30, 1);
  connect(map);
  ASSERT_EQ(exchange(10, 10), BusStatus::ok) << board_->detail();
  EXPECT_EQ(board_->clients(), 1U);
  server_.set_input(30, 3);
  ASSERT_EQ(exchange(10, 10), BusStatus::ok) << board_->detail();
  EXPECT_EQ(board_->clients(), 3U);
  map.watchdog.feed = BoardWatchdog::Feed::functions;
  map.watchdog.functions = {16};
  connect(map);
  EXPECT_FALSE(board_->fed_by_readers());
}

/// Tests a board whose watchdog trip remains until a client clears it. The board sets coil 32 at a trip. A
/// client clears the trip by writing 1 to coil 33. During a trip, the board confirms writes, but its outputs
/// (holding registers 10 and 11) remain 0.
class WatchdogTest : public ModbusBoardTest {
 protected:
  WatchdogTest() {
    map_ = shipped("adam-6024.yaml");
    map_.read_back.reset();
    map_.input_status.reset();
    map_.watchdog.tripped = BoardWatchdog::Tripped{.function = 1, .address = 32, .mask = 1};
    map_.watchdog.clear = {FixedWrite{.function = 5, .address = 33, .value = 1}};
    server_.on_request([](RegisterServer& server, const RegisterServer::Request& request) {
      if (request.function == 5 && request.write_address == 33) {
        server.coils_[32] = 0;
        server.ignore_writes(false);
      }
    });
  }

  void trip() {
    server_.set_coil(32, 1);
    server_.set_holding(10, 0);
    server_.set_holding(11, 0);
    server_.ignore_writes(true);
  }

  BoardMap map_;
};

TEST_F(WatchdogTest, AnExchangeReportsATripWithoutClearingTheTrip) {
  connect(map_);
  ASSERT_EQ(exchange(10, 10), BusStatus::ok);
  trip();
  for (int i = 0; i < 3; ++i) EXPECT_EQ(exchange(10, 10), BusStatus::watchdog_tripped);
  EXPECT_EQ(server_.holding(10), 0) << "outputs remain at their safe values until the next connection";
  EXPECT_EQ(server_.coil(32), 1);
  EXPECT_EQ(readings_[0].sequence, 1U);
}

TEST_F(WatchdogTest, TheFirstExchangeWritesCommandsBeforeAndAfterClearing) {
  connect(map_);
  trip();
  ASSERT_EQ(exchange(50, 50), BusStatus::ok) << board_->detail();
  const Requests requests = server_.take_requests();
  const RegisterServer::Request write{16, 10, 0, 10, {2048, 2048}};
  ASSERT_EQ(requests.size(), 6U);
  EXPECT_EQ(requests[0], write);
  EXPECT_EQ(requests[1].function, 1);
  EXPECT_EQ(requests[2].function, 5);
  EXPECT_EQ(requests[3], write);
  EXPECT_EQ(server_.holding(10), 2048);
  trip();
  EXPECT_EQ(exchange(50, 50), BusStatus::watchdog_tripped)
      << "only a trip before the first exchange of a session is cleared";
}

TEST_F(WatchdogTest, AWatchdogThatDidNotTripIsNotCleared) {
  connect(map_);
  ASSERT_EQ(exchange(10, 10), BusStatus::ok);
  for (const auto& request : server_.take_requests()) EXPECT_NE(request.function, 5);
  trip();
  EXPECT_EQ(exchange(10, 10), BusStatus::watchdog_tripped)
      << "a trip after the first exchange of a session is not cleared";
}

TEST_F(WatchdogTest, EveryExchangeSendsOneWatchdogWrite) {
  map_.watchdog.feed = BoardWatchdog::Feed::feed_write;
  map_.watchdog.feed_write = FixedWrite{.function = 6, .address = 4099, .value = 1};
  connect(map_);
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(exchange(10, 10), BusStatus::ok);
    int fed = 0;
    for (const auto& request : server_.take_requests()) fed += request.write_address == 4099 ? 1 : 0;
    EXPECT_EQ(fed, 1);
  }
}

TEST_F(WatchdogTest, AHeartbeatAlternatesOnlyAfterAConfirmedWrite) {
  map_.watchdog.feed = BoardWatchdog::Feed::feed_write;
  map_.watchdog.feed_write = FixedWrite{.function = 6, .address = 4099, .value = 7, .alternate = 9};
  connect(map_);
  for (const int beat : {7, 9, 7, 9, 7}) {
    ASSERT_EQ(exchange(10, 10), BusStatus::ok) << board_->detail();
    EXPECT_EQ(server_.holding(4099), beat);
  }
  server_.refuse(std::uint8_t{6}, 6);
  EXPECT_EQ(exchange(10, 10), BusStatus::exception);
  server_.refuse(std::nullopt);
  ASSERT_EQ(exchange(10, 10), BusStatus::ok) << board_->detail();
  EXPECT_EQ(server_.holding(4099), 9);
}

/// During a watchdog trip, this board responds to writes with an exception, as some bus couplers do.
TEST_F(WatchdogTest, DetectsATripByTheFlagIfWritesAreRefused) {
  map_.setup = {{6, 500, 7}};
  connect(map_);
  ASSERT_EQ(exchange(10, 10), BusStatus::ok);
  server_.set_coil(32, 1);
  server_.refuse(16, 4);
  EXPECT_EQ(exchange(10, 10), BusStatus::watchdog_tripped) << board_->detail();
  server_.on_request([](RegisterServer& server, const RegisterServer::Request& request) {
    if (request.function != 5 || request.write_address != 33) return;
    server.coils_[32] = 0;
    server.refuse(std::nullopt);
  });
  (void)server_.take_requests();
  ASSERT_EQ(board_->connect(generous), BusStatus::ok) << board_->detail();
  for (const auto& request : server_.take_requests()) {
    EXPECT_NE(request.function, 6) << "the setup writes could clear the trip before the outputs are written";
  }
  ASSERT_EQ(exchange(5, 5), BusStatus::ok) << board_->detail();
  int set_up = 0;
  for (const auto& request : server_.take_requests()) set_up += request.function == 6 ? 1 : 0;
  EXPECT_EQ(set_up, 1);
  EXPECT_EQ(server_.coil(32), 0);
}

}  // namespace
}  // namespace softgrip::drivers::modbus_board_test
