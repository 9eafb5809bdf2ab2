#include "daemon/service/safe_outputs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "base/files.h"
#include "base/periodic_schedule.h"
#include "drivers/iio/iio_board.h"
#include "tests/daemon/scripted_board.h"

namespace softgrip::daemon::safe_outputs_test {
namespace {

using drivers::BusStatus;
using testing::ScriptedBoard;

/// A board whose first calls of connect() and exchange() fail and whose later calls succeed.
class RecoveringBoard final : public drivers::Board {
 public:
  RecoveringBoard(ScriptedBoard& inner, int refused_connects, int refused_exchanges)
      : inner_(inner), refused_connects_(refused_connects), refused_exchanges_(refused_exchanges) {}

  std::chrono::nanoseconds longest_deadline{0};  ///< longest deadline of connect()

  [[nodiscard]] std::size_t channels() const noexcept override { return inner_.channels(); }
  [[nodiscard]] BusStatus connect(std::chrono::nanoseconds deadline) noexcept override {
    longest_deadline = std::max(longest_deadline, deadline);
    return refused_connects_-- > 0 ? BusStatus::disconnected : inner_.connect(deadline);
  }
  [[nodiscard]] BusStatus exchange(std::span<const double> commands_kpa, std::span<drivers::Reading> readings,
                                   std::chrono::nanoseconds deadline) noexcept override {
    return refused_exchanges_-- > 0 ? BusStatus::timed_out
                                    : inner_.exchange(commands_kpa, readings, deadline);
  }
  [[nodiscard]] std::string describe() const override { return "recovering board"; }
  [[nodiscard]] Budget budget() const override { return {}; }
  [[nodiscard]] bool has_watchdog() const noexcept override { return false; }
  [[nodiscard]] std::chrono::nanoseconds watchdog_time() const noexcept override {
    return std::chrono::nanoseconds(0);
  }

 private:
  ScriptedBoard& inner_;
  int refused_connects_;
  int refused_exchanges_;
};

class SafeOutputsTest : public ::testing::Test {
 protected:
  SafeOutputsTest() {
    rig_.settings.channels.resize(2);
    rig_.settings.channels[0].limits.pressure_min_kpa = 0;
    rig_.settings.channels[1].limits.pressure_min_kpa = 2;
    rig_.reconnect.first_pause = std::chrono::milliseconds(1);
  }
  SafeOutputsReport write(drivers::Board& board,
                          std::chrono::nanoseconds patience = std::chrono::seconds(5)) {
    return write_safe_outputs(rig_, board, clock_, patience);
  }

  rig::RigFile rig_;
  MonotonicClock clock_;
  ScriptedBoard board_{2, clock_};
};

TEST_F(SafeOutputsTest, WritesTheLowestPressureOfEachChannelAndNothingElse) {
  EXPECT_EQ(write(board_).end, SafeOutputsEnd::confirmed);
  ASSERT_EQ(board_.written.size(), 2U);
  for (const auto& written : board_.written) EXPECT_EQ(written, (std::vector<double>{0, 2}));
}

TEST_F(SafeOutputsTest, WritesTheRestPressureOnAVacuumChannel) {
  rig_.settings.channels[0].limits = {-40, 60};
  rig_.settings.channels[1].limits = {-40, 60};
  rig_.settings.channels[1].limits.rest_kpa = -10;
  EXPECT_EQ(write(board_).end, SafeOutputsEnd::confirmed);
  for (const auto& written : board_.written) EXPECT_EQ(written, (std::vector<double>{0, -10}));
}

TEST_F(SafeOutputsTest, ReconnectsUntilTheBoardConfirms) {
  RecoveringBoard board(board_, 3, 2);
  EXPECT_EQ(write(board).end, SafeOutputsEnd::confirmed);
  EXPECT_EQ(board_.written.size(), 2U);
  EXPECT_EQ(board_.connect_attempts.size(), 3U);  // one connection at the start, one after each of the 2
                                                  // exchanges without a response
}

TEST_F(SafeOutputsTest, VentsTheOutputsOfConvertersIfAnInputIsMissing) {
  const ScratchFolder root;
  std::filesystem::create_directory(root.path() + "/iio:device0");
  const std::string dac = root.path() + "/iio:device0/";
  std::ofstream(dac + "name") << "dac7578\n";
  drivers::IioSettings settings;
  settings.root = root.path();
  settings.inputs = {{"ads1115", "voltage0", 0}};
  for (const std::string channel : {"voltage0", "voltage1"}) {
    std::ofstream(dac + "out_" + channel + "_raw") << "2000\n";
    std::ofstream(dac + "out_" + channel + "_scale") << "0.8\n";
    drivers::ChannelWiring wiring;
    wiring.valve.output = settings.outputs.size();
    wiring.valve.scaling = {0, 0, 3.2, 100};
    settings.outputs.push_back({"dac7578", channel, 4095});
    settings.wiring.push_back(wiring);
  }
  drivers::IioBoard converters(settings);
  const SafeOutputsReport report = write(converters, std::chrono::milliseconds(20));
  EXPECT_EQ(report.end, SafeOutputsEnd::board_silent);
  EXPECT_NE(report.text.find("`ads1115`"), std::string::npos) << report.text;
  const auto raw_of = [&](const std::string& channel) {
    long raw = -1;
    std::ifstream(dac + "out_" + channel + "_raw") >> raw;
    return raw;
  };
  EXPECT_EQ(raw_of("voltage0"), 0);
  EXPECT_EQ(raw_of("voltage1"), 80) << "the rest pressure is 2 kPa";
}

TEST_F(SafeOutputsTest, ALongPauseOfTheRigFileDoesNotPreventTheNextAttempt) {
  rig_.reconnect.first_pause = std::chrono::seconds(20);
  RecoveringBoard board(board_, 1, 0);
  const Nanoseconds start = clock_.now();
  EXPECT_EQ(write(board).end, SafeOutputsEnd::confirmed);
  EXPECT_LT(clock_.now() - start, 4 * ns_per_s);
  EXPECT_EQ(board_.written.size(), 2U);
}

TEST_F(SafeOutputsTest, NoConnectionTakesLongerThanTheRemainingTime) {
  rig_.reconnect.connect_deadline = std::chrono::seconds(30);
  rig_.reconnect.first_pause = std::chrono::seconds(20);
  RecoveringBoard board(board_, 1'000'000, 0);
  const Nanoseconds start = clock_.now();
  EXPECT_EQ(write(board, std::chrono::milliseconds(100)).end, SafeOutputsEnd::board_silent);
  EXPECT_LT(clock_.now() - start, ns_per_s / 2);
  EXPECT_LE(board.longest_deadline, std::chrono::milliseconds(100));
}

TEST_F(SafeOutputsTest, AWriteAtTheEndOfTheTimeIsStillConfirmed) {
  board_.on_exchange = [] { sleep_until(MonotonicClock().now() + ns_per_s / 20); };
  EXPECT_EQ(write(board_, std::chrono::milliseconds(20)).end, SafeOutputsEnd::confirmed);
}

TEST_F(SafeOutputsTest, ABoardWithoutResponseIsReportedAsSilent) {
  board_.next_connect = BusStatus::disconnected;
  const SafeOutputsReport report = write(board_, std::chrono::milliseconds(20));
  EXPECT_EQ(report.end, SafeOutputsEnd::board_silent);
  EXPECT_EQ(exit_code_of(report.end), ExitCode::io);
  EXPECT_TRUE(board_.written.empty());
}

TEST_F(SafeOutputsTest, ATrippedBoardWatchdogCountsAsSafe) {
  board_.next_exchange = BusStatus::watchdog_tripped;
  EXPECT_EQ(write(board_).end, SafeOutputsEnd::board_holds);
}

TEST_F(SafeOutputsTest, SafeOutputsAreNotNeededAfterASuccessfulExit) {
  EXPECT_FALSE(safe_outputs_needed("success"));
  for (const char* result : {"", "exit-code", "signal", "core-dump", "watchdog", "timeout"})
    EXPECT_TRUE(safe_outputs_needed(result)) << result;
  EXPECT_EQ(exit_code_of(SafeOutputsEnd::not_needed), ExitCode::done);
}

}  // namespace
}  // namespace softgrip::daemon::safe_outputs_test
