#include "daemon/loop/bus.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string_view>
#include <vector>

#include "tests/daemon/scripted_board.h"

namespace softgrip::daemon::bus_test {
namespace {

using control::FaultCode;
using drivers::BusStatus;
using testing::ScriptedBoard;

constexpr Nanoseconds period = 5'000'000;

class BusTest : public ::testing::Test {
 protected:
  void command(double command_kpa, double safe_kpa, bool may_rise, std::uint32_t inhibit = 0) {
    Commands commands;
    commands.command_kpa.fill(command_kpa);
    commands.safe_kpa.fill(safe_kpa);
    commands.may_rise = may_rise;
    commands.inhibit = inhibit;
    shared_.commands.publish(commands);
  }
  void step() { step(bus_); }
  void step(Bus& bus) {
    bus.step(clock_.now());
    clock_.advance(period);
    shared_.bus.fetch();
  }
  Bus make_bus() { return Bus(board_, rig_, loop_, reconnect_, clock_, shared_, statistics_); }
  FaultCode fault() { return shared_.bus.value().health.fault; }
  double last_written() const { return board_.written.back().front(); }
  std::vector<BusEvent::Kind> events() {
    std::vector<BusEvent::Kind> kinds;
    for (BusEvent event; shared_.bus_events.pop(event);) kinds.push_back(event.kind);
    return kinds;
  }

  /// The board refuses a write in the next exchange, and its outputs have 5 kPa.
  void refuse_a_write() {
    board_.next_exchange = BusStatus::write_refused;
    board_.found = 5;
    step();
  }
  void run_for_two_seconds() {
    for (const Nanoseconds begin = clock_.now(); clock_.now() - begin < 2 * ns_per_s;) {
      command(12, 0, true);
      step();
    }
  }
  /// Checks that the pauses between the attempts to connect double until the longest pause of 400 ms.
  void expect_growing_pauses() const {
    const auto& attempts = board_.connect_attempts;
    ASSERT_GE(attempts.size(), 5U);
    const std::vector<Nanoseconds> pauses_ms{100, 200, 400, 400};
    for (std::size_t i = 0; i < pauses_ms.size(); ++i) {
      EXPECT_NEAR(static_cast<double>(attempts[i + 1] - attempts[i]), static_cast<double>(pauses_ms[i]) * 1e6,
                  static_cast<double>(period));
    }
  }

  VirtualClock clock_;
  ScriptedBoard board_{2, clock_};
  control::RigSettings rig_;
  rig::LoopSettings loop_;
  rig::ReconnectSettings reconnect_;
  SharedState shared_{16};
  BusStatistics statistics_;
  Bus bus_{board_, rig_, loop_, reconnect_, clock_, shared_, statistics_};
};

TEST_F(BusTest, WritesNothingBeforeTheFirstCommand) {
  for (int i = 0; i < 20; ++i) step();
  EXPECT_TRUE(board_.written.empty());
  EXPECT_TRUE(board_.connect_attempts.empty());
}

TEST_F(BusTest, WritesTheNewestCommandsAndPublishesTheReadings) {
  command(12, 0, true);
  step();
  EXPECT_EQ(board_.written, (std::vector<std::vector<double>>{{12, 12}}));
  const BusReport& report = shared_.bus.value();
  EXPECT_TRUE(report.health.connected);
  EXPECT_EQ(report.health.fault, FaultCode::none);
  EXPECT_EQ(report.readings[1].validity, model::Validity::valid);
  EXPECT_EQ(events(), std::vector<BusEvent::Kind>{BusEvent::Kind::connected});
}

TEST_F(BusTest, SafeOutputsLastUntilTheLoopConfirmsTheInhibition) {
  command(12, 3, true);
  step();
  for (std::uint32_t i = 1; i < loop_.max_missed_commands; ++i) {
    step();
    EXPECT_EQ(last_written(), 12);
  }
  step();
  EXPECT_EQ(last_written(), 3);
  EXPECT_EQ(fault(), FaultCode::cycles_lost);
  EXPECT_EQ(shared_.bus.value().outputs_kpa[0], 3);
  command(14, 3, true);  // the loop continues its motion, because it does not know that the outputs have
                         // changed
  step();
  EXPECT_EQ(last_written(), 3);
  command(4, 3, false);  // the loop has ended its motion, but it does not know that the outputs have changed
  step();
  EXPECT_EQ(last_written(), 3);
  command(4, 3, false,
          shared_.bus.value().health.inhibit);  // the loop knows that motion is inhibited, but its command is
                                                // above the outputs
  step();
  EXPECT_EQ(last_written(), 3);
  EXPECT_EQ(fault(), FaultCode::cycles_lost);
  command(2, 2, false, shared_.bus.value().health.inhibit);
  step();
  EXPECT_EQ(last_written(), 2);
  EXPECT_EQ(fault(), FaultCode::none);
  command(5, 2, true, shared_.bus.value().health.inhibit);
  step();
  EXPECT_EQ(last_written(), 5);
  EXPECT_EQ(events(), (std::vector<BusEvent::Kind>{BusEvent::Kind::connected, BusEvent::Kind::loop_silent,
                                                   BusEvent::Kind::loop_back}));
}

TEST_F(BusTest, AfterACommandTimeoutOnlyLowerCommandsAreWritten) {
  command(12, 9, true);
  step();
  for (std::uint32_t i = 0; i < loop_.max_missed_commands; ++i) step();
  EXPECT_EQ(last_written(), 9);
  command(7, 9, true);
  step();
  EXPECT_EQ(last_written(), 7);
  command(8, 9, true);
  step();
  EXPECT_EQ(last_written(), 7);
}

class WatchedBusTest : public BusTest {
 protected:
  static constexpr Nanoseconds watchdog = 500'000'000;
  static constexpr Nanoseconds margin = 50'000'000;  // deadline of an exchange with the board [ns]
  WatchedBusTest() {
    board_.watchdog = std::chrono::nanoseconds(watchdog);
    rig_.channels.resize(2);
    for (control::ChannelSettings& channel : rig_.channels) channel.limits.pressure_min_kpa = 1;
  }
};

TEST_F(WatchedBusTest, AGapOfTheWatchdogTimeIsAFaultAndBlocksRises) {
  Bus bus = make_bus();
  command(35, 35, true);
  step(bus);
  clock_.advance(watchdog);
  command(35, 35, true);
  step(bus);
  EXPECT_EQ(last_written(), 1);
  EXPECT_EQ(fault(), FaultCode::board_watchdog_tripped);
  EXPECT_EQ(shared_.bus.value().outputs_kpa[1], 1);
  command(35, 35, false);  // the loop has latched a different fault and does not know of the watchdog trip
  step(bus);
  EXPECT_EQ(last_written(), 1);
  command(1, 1, false, shared_.bus.value().health.inhibit);
  step(bus);
  EXPECT_EQ(fault(), FaultCode::none);
}

TEST_F(WatchedBusTest, AGapStartsWhenTheLastGoodExchangeBegins) {
  for (const Nanoseconds gap : {watchdog - margin - 1, watchdog - margin}) {
    Bus bus = make_bus();
    command(35, 35, true);
    step(bus);
    clock_.advance(gap - period);
    command(35, 35, true);
    step(bus);
    EXPECT_EQ(last_written(), gap < watchdog - margin ? 35 : 1) << gap;
  }
}

TEST_F(WatchedBusTest, FailedExchangesDoNotEndAGap) {
  Bus bus = make_bus();
  command(35, 35, true);
  step(bus);
  board_.next_exchange = BusStatus::exception;
  for (Nanoseconds begin = clock_.now(); clock_.now() - begin < watchdog;) {
    command(35, 35, true);
    step(bus);
  }
  board_.next_exchange = BusStatus::ok;
  step(bus);
  EXPECT_EQ(last_written(), 1);
  EXPECT_EQ(fault(), FaultCode::board_watchdog_tripped);
}

TEST_F(WatchedBusTest, AGapIsReportedOnceDuringLongExchangeFailures) {
  Bus bus = make_bus();
  command(35, 35, true);
  step(bus);
  clock_.advance(watchdog);
  board_.next_exchange = BusStatus::exception;
  for (int i = 0; i < 200; ++i) {
    command(1, 1, false, shared_.bus.value().health.inhibit);
    step(bus);
  }
  EXPECT_EQ(shared_.bus.value().health.inhibit, 1U);
  EXPECT_EQ(events(), (std::vector<BusEvent::Kind>{BusEvent::Kind::connected, BusEvent::Kind::failed}));
}

TEST_F(WatchedBusTest, TheFirstWriteIsInRangeAfterAFailedConnection) {
  Bus bus = make_bus();
  board_.next_connect = BusStatus::disconnected;
  command(1, 1, false);
  step(bus);
  board_.next_connect = BusStatus::ok;
  clock_.advance(ns_per_s);
  step(bus);
  EXPECT_EQ(last_written(), 1);
}

TEST_F(WatchedBusTest, AnExchangeLongerThanTheWatchdogIsAFault) {
  Bus bus = make_bus();
  command(35, 35, true);
  step(bus);
  board_.on_exchange = [this] { clock_.advance(watchdog); };
  command(35, 35, true);
  step(bus);
  board_.on_exchange = nullptr;
  EXPECT_EQ(fault(), FaultCode::board_watchdog_tripped);
  EXPECT_EQ(shared_.bus.value().outputs_kpa[0], 1);
  step(bus);
  EXPECT_EQ(last_written(), 1);
}

TEST_F(WatchedBusTest, AFailedExchangeLongerThanTheWatchdogIsReportedAsAGap) {
  Bus bus = make_bus();
  command(35, 35, true);
  step(bus);
  EXPECT_EQ(events(), std::vector<BusEvent::Kind>{BusEvent::Kind::connected});
  board_.on_exchange = [this] { clock_.advance(watchdog); };
  board_.next_exchange = BusStatus::timed_out;
  command(35, 35, true);
  step(bus);
  EXPECT_EQ(fault(), FaultCode::board_watchdog_tripped);
  EXPECT_EQ(shared_.bus.value().outputs_kpa[0], 1);
  BusEvent event;
  ASSERT_TRUE(shared_.bus_events.pop(event));
  EXPECT_EQ(event.status, BusStatus::watchdog_tripped);
  EXPECT_NE(std::string_view(event.detail.data()).find("no successful exchange"), std::string_view::npos);
  EXPECT_FALSE(shared_.bus_events.pop(event)) << "one event for one cause";
}

/// Tests a rig with a pressure range from -40 to 60 kPa and a rest pressure of 0 kPa.
class VacuumBusTest : public WatchedBusTest {
 protected:
  VacuumBusTest() {
    for (control::ChannelSettings& channel : rig_.channels) {
      channel.limits.pressure_min_kpa = -40;
      channel.limits.pressure_max_kpa = 60;
    }
  }
};

TEST_F(VacuumBusTest, OutputsLeaveRestOnEitherSideOnlyWhileASequenceRuns) {
  Bus bus = make_bus();
  command(-12, 0, true);
  step(bus);
  EXPECT_EQ(last_written(), -12);
  command(-13, 0, false);  // the loop computed this command before it received the end of the sequence
  step(bus);
  EXPECT_EQ(last_written(), -12);
  command(-11, 0, false);
  step(bus);
  EXPECT_EQ(last_written(), -11);
  command(5, 0, false);  // a command on the other side of the rest pressure is also a motion away from rest
  step(bus);
  EXPECT_EQ(last_written(), 0);
}

TEST_F(VacuumBusTest, AWatchdogTripSetsOutputsToRestNotToVacuum) {
  for (const double before_kpa : {35.0, -35.0}) {
    Bus bus = make_bus();
    command(before_kpa, before_kpa, true);
    step(bus);
    clock_.advance(watchdog);
    command(before_kpa, before_kpa, true);
    step(bus);
    EXPECT_EQ(last_written(), 0);
    EXPECT_EQ(fault(), FaultCode::board_watchdog_tripped);
    command(-1, -1, false,
            shared_.bus.value().health.inhibit);  // the loop knows of the watchdog trip, but its command is
                                                  // not the rest pressure
    step(bus);
    EXPECT_EQ(last_written(), 0);
    EXPECT_EQ(fault(), FaultCode::board_watchdog_tripped);
    command(0, 0, false, shared_.bus.value().health.inhibit);
    step(bus);
    EXPECT_EQ(fault(), FaultCode::none);
  }
}

TEST_F(VacuumBusTest, UnconfirmedOutputsAreReportedNearerToRest) {
  Bus bus = make_bus();
  command(-12, 0, true);
  step(bus);
  board_.next_exchange = BusStatus::exception;
  command(-13, 0, true);
  step(bus);
  EXPECT_EQ(shared_.bus.value().outputs_kpa[0], -12);
  command(-11, 0, true);
  step(bus);
  EXPECT_EQ(shared_.bus.value().outputs_kpa[0], -11);
  command(3, 0, true);
  step(bus);
  EXPECT_EQ(shared_.bus.value().outputs_kpa[0], 0)
      << "the output may be above or below the rest pressure, so only the rest pressure is safe";
}

/// If several attempts to connect fail for the same reason, the event log must contain this reason only once.
TEST_F(BusTest, ANewConnectionFailureReasonIsReportedOnce) {
  const auto failures = [this] {
    std::vector<std::string> texts;
    for (BusEvent event; shared_.bus_events.pop(event);) {
      if (event.kind == BusEvent::Kind::failed) texts.emplace_back(event.detail.data());
      if (event.kind == BusEvent::Kind::not_connected)
        texts.push_back(std::string("again: ") + event.detail.data());
    }
    return texts;
  };
  command(12, 0, true);
  step();
  const std::string refusal =
      "`mcp4725` fits 2 converters: iio:device0 (name `mcp4725`, address `1-0060`) and "
      "iio:device1 (name `mcp4725`, address `1-0061`)";
  for (int outage = 0; outage < 2; ++outage) {
    board_.next_exchange = BusStatus::disconnected;
    board_.next_connect = BusStatus::disconnected;
    board_.said = "gone";
    step();
    EXPECT_EQ(failures(), (std::vector<std::string>{"gone"}));
    for (int i = 0; i < 5; ++i) {
      clock_.advance(60'000'000'000);
      step();
    }
    EXPECT_TRUE(failures().empty()) << "the reason for the failure has not changed";
    board_.said = refusal.c_str();
    for (int i = 0; i < 5; ++i) {
      clock_.advance(60'000'000'000);
      step();
    }
    EXPECT_EQ(failures(), (std::vector<std::string>{"again: " + refusal}))
        << "the complete text of a new failure reason is reported once";
    board_.next_exchange = BusStatus::ok;
    board_.next_connect = BusStatus::ok;
    clock_.advance(60'000'000'000);
    step();
    step();
    (void)failures();
  }
}

/// A board of converters opens a session although a converter is missing. Its first exchange then fails.
TEST_F(BusTest, ANewReasonOfAFailedFirstExchangeIsReportedOnce) {
  command(12, 0, true);
  step();
  board_.next_exchange = BusStatus::disconnected;
  board_.said = "gone";
  step();
  board_.said = "it was mcp4725 at 1-0060, but now it is mcp4725 at 1-0062";
  std::vector<std::string> again;
  for (int i = 0; i < 5; ++i) {
    clock_.advance(60'000'000'000);
    step();
    for (BusEvent event; shared_.bus_events.pop(event);) {
      if (event.kind == BusEvent::Kind::not_connected) again.emplace_back(event.detail.data());
    }
  }
  EXPECT_EQ(again, std::vector<std::string>{board_.said});
}

/// If a board accepts a connection and closes it immediately, no event may report that the board is
/// connected.
TEST_F(BusTest, AConnectionIsReportedAfterTheFirstResponse) {
  const auto told = [this] {
    std::vector<std::pair<BusEvent::Kind, BusStatus>> list;
    for (BusEvent event; shared_.bus_events.pop(event);) list.emplace_back(event.kind, event.status);
    return list;
  };
  using Told = decltype(told());
  using Kind = BusEvent::Kind;
  command(12, 0, true);
  board_.next_connect = BusStatus::disconnected;
  board_.said = "connecting: Connection refused";
  step();
  EXPECT_EQ(told(), (Told{{Kind::failed, BusStatus::disconnected}}));
  board_.next_connect = BusStatus::ok;
  board_.next_exchange = BusStatus::closed_at_once;
  board_.said = "waiting for the reply: closed";
  for (int i = 0; i < 5; ++i) {
    clock_.advance(60 * ns_per_s);
    step();
  }
  EXPECT_EQ(told(), (Told{{Kind::not_connected, BusStatus::closed_at_once}}))
      << "the failed connection is reported once";
  EXPECT_EQ(fault(), FaultCode::bus_down);
  EXPECT_FALSE(shared_.bus.value().health.connected);
  board_.next_exchange = BusStatus::exception;
  for (int i = 0; i < 3; ++i) {
    clock_.advance(60 * ns_per_s);
    step();
  }
  EXPECT_EQ(told(), (Told{{Kind::connected, BusStatus::ok}}))
      << "a Modbus exception also counts as a response";
  board_.next_exchange = BusStatus::ok;
  step();
  EXPECT_EQ(told(), (Told{{Kind::recovered, BusStatus::ok}}));
}

TEST_F(BusTest, AClientResettingTheWatchdogIsReportedOncePerSession) {
  const std::vector<BusEvent::Kind> none;
  command(12, 0, true);
  board_.counted_clients = 2;
  step();
  (void)events();
  step();
  EXPECT_EQ(events(), none)
      << "only writes reset this watchdog, and the driver detects writes of another client at the outputs";
  board_.readers_feed = true;
  board_.counted_clients = 1;
  step();
  EXPECT_EQ(events(), none)
      << "no other client is connected, although requests of any client reset this watchdog";
  for (const unsigned clients : {3U, 1U, 2U}) {
    board_.counted_clients = clients;
    step();
    BusEvent event;
    EXPECT_EQ(shared_.bus_events.pop(event), clients == 3U);
    if (clients != 3U) continue;
    EXPECT_EQ(event.kind, BusEvent::Kind::another_client);
    EXPECT_STREQ(event.detail.data(), "3");
  }
  board_.next_exchange = BusStatus::timed_out;
  step();
  board_.next_exchange = BusStatus::ok;
  (void)events();
  step();
  EXPECT_EQ(events(), (std::vector<BusEvent::Kind>{BusEvent::Kind::connected, BusEvent::Kind::recovered,
                                                   BusEvent::Kind::another_client}));
}

TEST_F(BusTest, OutputsRiseOnlyWhileASequenceRuns) {
  command(12, 0, true);
  step();
  command(13, 0, false);  // the loop computed this command before it received the end of the sequence
  step();
  EXPECT_EQ(last_written(), 12);
  command(11, 0, false);
  step();
  EXPECT_EQ(last_written(), 11);
}

TEST_F(BusTest, ABoardWithoutWatchdogKeepsItsOutputsThroughAnyGap) {
  command(35, 35, true);
  step();
  clock_.advance(60 * ns_per_s);
  command(35, 35, true);
  step();
  EXPECT_EQ(last_written(), 35);
  EXPECT_EQ(fault(), FaultCode::none);
}

TEST_F(BusTest, CommandsSentDuringAReconnectionAreWritten) {
  command(12, 0, true);
  step();
  board_.next_exchange = BusStatus::timed_out;
  step();
  board_.next_exchange = BusStatus::ok;
  board_.on_connect = [this] { command(2, 0, false); };
  command(13, 0, true);
  step();
  EXPECT_EQ(last_written(), 2);
}

TEST_F(BusTest, UnconfirmedOutputsAreReportedAsTheLowerValue) {
  EXPECT_TRUE(std::isinf(shared_.bus.value().outputs_kpa[0]));
  command(12, 0, true);
  step();
  EXPECT_EQ(shared_.bus.value().outputs_kpa[0], 12);
  board_.next_exchange = BusStatus::exception;
  command(13, 0, true);
  step();
  EXPECT_EQ(shared_.bus.value().outputs_kpa[0], 12);
  command(11, 0, true);
  step();
  EXPECT_EQ(shared_.bus.value().outputs_kpa[0], 11);
}

TEST_F(BusTest, ReconnectionPausesGrowAfterALostSession) {
  reconnect_.longest_pause = std::chrono::milliseconds(400);
  command(12, 0, true);
  step();
  board_.next_exchange = BusStatus::timed_out;
  step();
  EXPECT_FALSE(shared_.bus.value().health.connected);
  EXPECT_EQ(shared_.bus.value().health.fault, FaultCode::bus_timed_out);
  board_.connect_attempts.clear();
  board_.next_connect = BusStatus::disconnected;
  run_for_two_seconds();
  EXPECT_EQ(shared_.bus.value().health.fault, FaultCode::bus_down);
  expect_growing_pauses();
  board_.next_connect = BusStatus::ok;
  board_.next_exchange = BusStatus::ok;
  for (int i = 0; i < 100; ++i) {
    command(12, 0, true);
    step();
  }
  EXPECT_EQ(shared_.bus.value().health.fault, FaultCode::none);
  EXPECT_EQ(shared_.bus.value().health.consecutive_failures, 0U);
  EXPECT_EQ(events(), (std::vector<BusEvent::Kind>{BusEvent::Kind::connected, BusEvent::Kind::failed,
                                                   BusEvent::Kind::connected, BusEvent::Kind::recovered}));
}

TEST_F(BusTest, SessionsThatFailAtOnceIncreaseTheReconnectionPause) {
  reconnect_.longest_pause = std::chrono::milliseconds(400);
  command(12, 0, true);
  step();
  board_.next_exchange = BusStatus::bad_reply;
  step();
  board_.connect_attempts.clear();
  run_for_two_seconds();
  ASSERT_LE(board_.connect_attempts.size(), 8U);
  expect_growing_pauses();
  // If an exchange is lost after good exchanges, the bus opens a new session immediately.
  board_.next_exchange = BusStatus::ok;
  for (int i = 0; i < 100; ++i) step();
  board_.next_exchange = BusStatus::timed_out;
  step();
  board_.connect_attempts.clear();
  step();
  EXPECT_EQ(board_.connect_attempts.size(), 1U);
}

TEST_F(BusTest, CyclesWithoutASessionCountAsFailures) {
  board_.next_connect = BusStatus::disconnected;
  for (int i = 0; i < 10; ++i) {
    command(12, 0, false);
    step();
  }
  EXPECT_EQ(shared_.bus.value().health.consecutive_failures, 10U);
}

TEST_F(BusTest, ARefusingResponseKeepsTheSession) {
  command(12, 0, true);
  step();
  for (const BusStatus status : {BusStatus::exception, BusStatus::write_refused}) {
    board_.next_exchange = status;
    step();
    EXPECT_TRUE(shared_.bus.value().health.connected);
    EXPECT_EQ(shared_.bus.value().health.fault, fault_of(status));
    EXPECT_EQ(shared_.bus.value().health.consecutive_failures, status == BusStatus::exception ? 1U : 2U);
  }
  EXPECT_EQ(board_.connect_attempts.size(), 1U);
}

// In this test, another Modbus client writes 5 kPa after the write of the daemon. The daemon then reads the
// outputs back.
TEST_F(BusTest, ReadOutputsNearerToRestLimitTheCommands) {
  command(12, 0, true);
  step();
  refuse_a_write();
  EXPECT_EQ(fault(), FaultCode::write_refused);
  EXPECT_EQ(shared_.bus.value().outputs_kpa[0], 5);
  board_.next_exchange = BusStatus::ok;
  step();
  EXPECT_EQ(last_written(), 5);
  command(12, 0, false, shared_.bus.value().health.inhibit);
  step();
  EXPECT_EQ(last_written(), 5) << "the command of 12 kPa must not be written: it is further from the rest "
                                  "pressure than the output of 5 kPa";
  command(4, 0, false, shared_.bus.value().health.inhibit);
  step();
  EXPECT_EQ(last_written(), 4);
}

TEST_F(BusTest, ReadOutputsAboveTheCommandOrNaNAreIgnored) {
  for (const double found : {20.0, std::numeric_limits<double>::quiet_NaN()}) {
    board_.found = found;
    command(12, 0, false, shared_.bus.value().health.inhibit);
    board_.next_exchange = BusStatus::ok;
    step();
    board_.next_exchange = BusStatus::write_refused;
    step();
    EXPECT_EQ(shared_.bus.value().outputs_kpa[0], 12);
  }
}

// A gateway may repeat an old reading, so the driver can read outputs that are nearer to rest than the
// commands. The daemon must then continue to hold the part.
TEST_F(BusTest, AHoldContinuesDespiteReadOutputsNearerToRest) {
  command(12, 12, true);
  step();
  refuse_a_write();
  board_.next_exchange = BusStatus::ok;
  step();
  EXPECT_EQ(last_written(), 12);
}

TEST_F(BusTest, ReadOutputsLimitTheFirstCommandsWithoutHold) {
  command(12, 12, true);
  step();
  refuse_a_write();
  board_.next_exchange = BusStatus::ok;
  command(11, 0, false, shared_.bus.value().health.inhibit);
  step();
  EXPECT_EQ(last_written(), 5);
}

TEST_F(BusTest, ABoardFaultIsReportedUntilTheLoopConfirms) {
  for (const BusStatus said : {BusStatus::watchdog_tripped, BusStatus::write_refused}) {
    command(12, 0, true);
    step();
    EXPECT_EQ(last_written(), 12);
    board_.next_exchange = said;
    step();
    EXPECT_EQ(shared_.bus.value().health.connected, said == BusStatus::write_refused)
        << "only a new session with the board clears a watchdog trip";
    EXPECT_EQ(fault(), fault_of(said));
    board_.next_exchange = BusStatus::ok;
    const double outputs_kpa = said == BusStatus::watchdog_tripped ? 0 : 12;
    for (int report = 0; report < 5; ++report) {
      command(14, 0, true);
      step();
      EXPECT_EQ(fault(), fault_of(said));
      EXPECT_TRUE(shared_.bus.value().health.connected);
      EXPECT_EQ(last_written(), outputs_kpa);
    }
    command(outputs_kpa, 0, false, shared_.bus.value().health.inhibit);
    step();
    EXPECT_EQ(fault(), FaultCode::none);
  }
}

TEST_F(BusTest, LastCommandsAreConfirmedDespiteAnUnreadFault) {
  command(12, 0, true);
  step();
  for (std::uint32_t i = 0; i < loop_.max_missed_commands; ++i) step();
  Commands last;
  last.last = true;
  last.command_kpa.fill(12);
  shared_.commands.publish(last);
  step();
  EXPECT_TRUE(shared_.safe_state_confirmed.load());
  EXPECT_EQ(last_written(), 0);
}

TEST_F(BusTest, SafeStateIsConfirmedOnlyAfterAGoodExchange) {
  Commands last;
  last.last = true;
  last.command_kpa.fill(1);
  shared_.commands.publish(last);
  shared_.shutdown_requested.store(true);
  board_.next_exchange = BusStatus::exception;
  step();
  EXPECT_FALSE(shared_.safe_state_confirmed.load());
  board_.next_exchange = BusStatus::ok;
  step();
  EXPECT_TRUE(shared_.safe_state_confirmed.load());
  EXPECT_EQ(last_written(), 1);
}

TEST(BusThread, TheShutdownEndsIfTheBoardDoesNotRespond) {
  const MonotonicClock clock;
  ScriptedBoard board(1, clock);
  board.next_connect = BusStatus::disconnected;
  const control::RigSettings rig;
  rig::LoopSettings loop;
  rig::ReconnectSettings reconnect;
  SharedState shared(16);
  BusStatistics statistics;
  Bus bus(board, rig, loop, reconnect, clock, shared, statistics);
  Commands last;
  last.last = true;
  shared.commands.publish(last);
  shared.shutdown_requested.store(true);
  const Nanoseconds begin = clock.now();
  bus.run(PeriodicSchedule(begin, period), std::chrono::milliseconds(50));
  EXPECT_FALSE(shared.safe_state_confirmed.load());
  EXPECT_GE(clock.now() - begin, 50'000'000);
  EXPECT_LT(clock.now() - begin, 2 * ns_per_s);
}

}  // namespace
}  // namespace softgrip::daemon::bus_test
