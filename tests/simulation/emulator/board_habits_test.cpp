// Tests boards and gateways with unusual behaviour, on real sockets and serial lines. The emulator simulates
// the behaviour. The driver can communicate with the emulator only if the rig file contains the key for this
// behaviour.

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <string>

#include "base/clock.h"
#include "rig/board_map_file.h"
#include "tests/simulation/emulator/running_rig.h"

namespace softgrip::simulation::board_habits_test {
namespace {

using namespace std::chrono_literals;
using drivers::BusStatus;
using drivers::ModbusBoard;
using drivers::ModbusSettings;
using test::RunningRig;
using test::RunningRigSettings;

constexpr auto deadline = 150ms;
constexpr auto generous = 5s;

drivers::BoardMap shipped(const std::string& name) {
  document::Problems problems;
  return *rig::load_board_map(SOFTGRIP_SOURCE_DIR "/config/boards/" + name, problems);
}

RunningRigSettings rig_with(FaultSpec habit) {
  habit.name = "habit";
  RunningRigSettings settings;
  settings.maps = {shipped("softgrip-sim.yaml")};
  settings.maps[0].watchdog.timeout_s = 60;  // watchdog time-out [s]: longer than any pause of a busy machine
  settings.maps[0].setup.clear();
  settings.names = {"sim"};
  settings.habits = {std::move(habit)};
  return settings;
}

FaultSpec settling(double settle_s) {
  FaultSpec habit = fault_of(FaultKind::settling);
  habit.settle_s = settle_s;
  return habit;
}

struct Client {
  explicit Client(const ModbusSettings& settings) : board(settings), readings(settings.wiring.size()) {}
  BusStatus exchange(double kpa, std::chrono::nanoseconds within = generous) {
    return board.exchange(std::vector<double>(readings.size(), kpa), readings, within);
  }
  ModbusBoard board;
  std::vector<model::Reading> readings;
};

/// The board ignores requests during the first 0.4 s of a connection. A client without a settle time
/// reconnects after each time-out. Each new connection begins with another 0.4 s without responses, so this
/// client never gets a response. The settle time does not delay safe outputs, because the board would ignore
/// every write during the 0.4 s.
TEST(BoardHabits, ABoardThatIgnoresFirstRequestsIsReachedAfterSettling) {
  RunningRig rig(rig_with(settling(0.4)));
  ModbusSettings settings = rig.board();
  settings.probes = 0;
  Client unsettled(settings);
  const MonotonicClock clock;
  const Nanoseconds before = clock.now();
  while (clock.now() - before < 1'000'000'000) {
    ASSERT_EQ(unsettled.board.connect(generous), BusStatus::ok);
    ASSERT_EQ(unsettled.exchange(0, deadline), BusStatus::timed_out)
        << "without a settle time, the board must not respond to the first request";
  }
  std::get<drivers::TcpAddress>(settings.links[0]).habits.settle_s = 0.4;
  Client settled(settings);
  for (int session = 0; session < 2; ++session) {  // tests the first session and the session after a
                                                   // reconnection
    ASSERT_EQ(settled.board.connect(generous), BusStatus::ok) << settled.board.detail();
    ASSERT_EQ(settled.exchange(10 + session), BusStatus::ok) << settled.board.detail();
  }
  EXPECT_NEAR(rig.stop().modules()[0].output(0), 1.1, 1e-3) << "output voltage [V]";
}

TEST(BoardHabits, TheSettleTimeIsPartOfTheDeadlineForConnecting) {
  RunningRig rig(rig_with(settling(0)));
  ModbusSettings settings = rig.board();
  std::get<drivers::TcpAddress>(settings.links[0]).habits.settle_s = 20;
  ModbusBoard board(settings);
  const MonotonicClock clock;
  const Nanoseconds before = clock.now();
  EXPECT_EQ(board.connect(200ms), BusStatus::timed_out);
  EXPECT_LT(clock.now() - before, 10'000'000'000);
  EXPECT_NE(std::string(board.detail()).find("settle_s"), std::string::npos) << board.detail();
}

/// If a request is lost, the driver repeats the request within the deadline of the exchange and keeps the
/// connection. A lost request therefore does not delay the safe outputs.
TEST(BoardHabits, ALostRequestIsRepeatedWithinTheDeadline) {
  FaultSpec habit = fault_of(FaultKind::lost_request);
  habit.replies = 1;
  for (const double repeat_after_s : {0.0, 0.03}) {
    RunningRig rig(rig_with(habit));
    ModbusSettings settings = rig.board();
    settings.probes = 0;
    std::get<drivers::TcpAddress>(settings.links[0]).habits.repeat_after_s = repeat_after_s;
    Client client(settings);
    ASSERT_EQ(client.board.connect(generous), BusStatus::ok);
    const auto expected = repeat_after_s > 0 ? BusStatus::ok : BusStatus::timed_out;
    EXPECT_EQ(client.exchange(10, 1s), expected) << client.board.detail();
  }
}

TEST(BoardHabits, AcceptsAWrongTransactionIdOnlyIfConfigured) {
  RunningRig rig(rig_with(fault_of(FaultKind::wrong_transaction)));
  ModbusSettings settings = rig.board();
  EXPECT_EQ(Client(settings).board.connect(generous), BusStatus::bad_reply);
  std::get<drivers::TcpAddress>(settings.links[0]).numbered = false;
  Client client(settings);
  ASSERT_EQ(client.board.connect(generous), BusStatus::ok) << client.board.detail();
  for (int i = 0; i < 20; ++i) ASSERT_EQ(client.exchange(10), BusStatus::ok) << client.board.detail();
}

RunningRigSettings serial_server(FaultSpec habit) {
  RunningRigSettings settings = rig_with(std::move(habit));
  settings.rtu_over_tcp = true;
  return settings;
}

ModbusSettings with_rtu_frames(ModbusSettings settings) {
  std::get<drivers::TcpAddress>(settings.links[0]).rtu_framing = true;
  return settings;
}

TEST(BoardHabits, ExchangesRtuFramesOverTcp) {
  RunningRig rig(serial_server(settling(0)));
  ModbusSettings settings = rig.board();
  EXPECT_EQ(Client(settings).board.connect(deadline), BusStatus::timed_out)
      << "the server expects RTU frames, but the driver sends TCP frames";
  settings = with_rtu_frames(settings);
  Client client(settings);
  ASSERT_EQ(client.board.connect(generous), BusStatus::ok) << client.board.detail();
  for (int i = 0; i < 20; ++i) ASSERT_EQ(client.exchange(20), BusStatus::ok) << client.board.detail();
  EXPECT_EQ(client.readings[0].validity, model::Validity::valid);
  EXPECT_NE(client.board.describe().find("RTU frames"), std::string::npos);
  settings.modules[0].unit = 9;
  EXPECT_EQ(Client(settings).board.connect(deadline), BusStatus::timed_out)
      << "the board has no unit with id 9";
  EXPECT_NEAR(rig.stop().modules()[0].output(0), 2, 1e-3) << "output voltage [V]";
}

TEST(BoardHabits, RtuFramesThatAreRepeatedOrWrongEndTheSession) {
  for (const FaultKind kind : {FaultKind::repeated_reply, FaultKind::wrong_unit, FaultKind::wrong_transaction,
                               FaultKind::wrong_length}) {
    RunningRig rig(serial_server(fault_of(kind)));
    Client client(with_rtu_frames(rig.board()));
    EXPECT_EQ(client.board.connect(1s), BusStatus::bad_reply)
        << name_of(kind) << ": " << client.board.detail();
  }
}

/// Tests a serial line of the computer, and a serial line that is connected through a network server.
TEST(BoardHabits, StrayBytesAreThrownAway) {
  FaultSpec habit = fault_of(FaultKind::stray_bytes);
  habit.before = 1;
  habit.behind = 2;
  RunningRigSettings on_a_line = rig_with(habit);
  on_a_line.wire = Wire::rtu;
  on_a_line.line.baud = 115200;
  for (const RunningRigSettings& settings : {on_a_line, serial_server(habit)}) {
    RunningRig rig(settings);
    Client client(settings.rtu_over_tcp ? with_rtu_frames(rig.board()) : rig.board());
    ASSERT_EQ(client.board.connect(generous), BusStatus::ok) << client.board.detail();
    for (int i = 0; i < 20; ++i) ASSERT_EQ(client.exchange(10), BusStatus::ok) << i << client.board.detail();
  }
}

/// The board has 8 inputs in 16 registers and 4 outputs in 8 registers. One request may contain at most 4
/// registers. The driver must not divide a value between two requests. It must assign each input to the
/// correct channel.
TEST(BoardHabits, ABoardThatTakesFewRegistersGetsSeveralRequests) {
  FaultSpec habit = fault_of(FaultKind::few_registers);
  habit.most = 4;
  RunningRigSettings settings = rig_with(habit);
  settings.channels = 4;
  RunningRig rig(settings);
  ModbusSettings reached = rig.board();
  Client greedy(reached);
  EXPECT_EQ(greedy.board.connect(generous), BusStatus::exception);
  EXPECT_NE(std::string(greedy.board.detail()).find("(exception 3)"), std::string::npos);
  reached.modules[0].map.max_registers = 4;
  Client modest(reached);
  ASSERT_EQ(modest.board.connect(generous), BusStatus::ok) << modest.board.detail();
  for (int i = 0; i < 20; ++i) ASSERT_EQ(modest.exchange(30), BusStatus::ok) << modest.board.detail();
  const Emulator& emulator = rig.stop();
  for (std::size_t channel = 0; channel < 4; ++channel) {
    EXPECT_NEAR(emulator.modules()[0].output(channel), 3, 1e-3) << "voltage [V] of output " << channel;
    EXPECT_EQ(modest.readings[channel].validity, model::Validity::valid);
    EXPECT_NEAR(modest.readings[channel].displacement_mm,
                emulator.fingers()[channel].plant().displacement_mm(), 1);
    EXPECT_NEAR(modest.readings[channel].pressure_kpa, emulator.fingers()[channel].plant().pressure_kpa(), 5);
  }
}

TEST(BoardHabits, TheWordOrderDecodesSwappedBytes) {
  for (const auto order :
       {drivers::WordOrder::high_first_bytes_swapped, drivers::WordOrder::low_first_bytes_swapped}) {
    RunningRigSettings settings = rig_with(settling(0));
    settings.maps[0].word_order = order;
    RunningRig rig(settings);
    ModbusSettings reached = rig.board();
    {
      Client right(reached);
      ASSERT_EQ(right.board.connect(generous), BusStatus::ok) << right.board.detail();
      ASSERT_EQ(right.exchange(20), BusStatus::ok) << right.board.detail();
      EXPECT_EQ(right.readings[0].validity, model::Validity::valid);
      EXPECT_NEAR(right.readings[0].displacement_mm, 0, 1);
    }
    reached.modules[0].map.word_order = drivers::WordOrder::high_first;
    Client wrong(reached);
    ASSERT_EQ(wrong.board.connect(generous), BusStatus::ok) << wrong.board.detail();
    (void)wrong.exchange(0);
    const bool believed = wrong.readings[0].validity == model::Validity::valid;
    EXPECT_FALSE(believed && std::abs(wrong.readings[0].displacement_mm) < 1) << drivers::name_of(order);
  }
}

}  // namespace
}  // namespace softgrip::simulation::board_habits_test
