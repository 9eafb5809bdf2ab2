// Tests every shipped board map with the driver and the emulator on real sockets and pseudo-terminals. A
// pressure written for one channel must move the finger of this channel. The driver must detect a watchdog
// trip. The trip must remain until a new session resets it.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <thread>

#include "rig/board_map_file.h"
#include "tests/simulation/emulator/running_rig.h"

namespace softgrip::simulation::shipped_boards_test {
namespace {

using namespace std::chrono_literals;
using drivers::BusStatus;

constexpr auto generous = 5s;
constexpr double test_timeout_s = 0.4;
const std::filesystem::path folder = std::filesystem::path(SOFTGRIP_SOURCE_DIR) / "config/boards";

struct Combination {
  std::vector<std::string> boards;  // names of the board map files without the ending .yaml
  Wire wire = Wire::tcp;
  std::size_t channels = 2;
};

std::vector<Combination> combinations() {
  return {{{"adam-6024"}},
          {{"softgrip-sim"}},
          {{"moxa-e1241", "moxa-e1240"}},
          {{"wago-750-559", "moxa-e1240"}},
          {{"festo-pgva", "moxa-e1240"}, Wire::tcp, 1},
          {{"waveshare-ao8", "waveshare-ai8"}, Wire::rtu},
          {{"waveshare-ao8-b", "waveshare-ai8-b"}, Wire::rtu}};
}

class ShippedBoard : public testing::TestWithParam<Combination> {
 protected:
  void SetUp() override {
    test::RunningRigSettings settings;
    settings.wire = GetParam().wire;
    settings.channels = GetParam().channels;
    settings.line.baud = 115200;
    for (const std::string& name : GetParam().boards) {
      document::Problems problems;
      auto map = rig::load_board_map((folder / (name + ".yaml")).string(), problems);
      ASSERT_TRUE(map.has_value()) << problems.format();
      if (map->watchdog.kind != drivers::BoardWatchdog::Kind::none) map->watchdog.timeout_s = test_timeout_s;
      settings.maps.push_back(*map);
      settings.names.push_back(name);
    }
    rig_ = std::make_unique<test::RunningRig>(settings);
    ASSERT_TRUE(drivers::problems_of(rig_->board()).empty());
    board_ = std::make_unique<drivers::ModbusBoard>(rig_->board());
    ASSERT_EQ(board_->connect(generous), BusStatus::ok) << board_->detail();
    readings_.resize(GetParam().channels);
  }

  [[nodiscard]] const drivers::BoardMap& output_map() const { return rig_->board().modules[0].map; }

  BusStatus exchange(double pressure_kpa) {
    const std::vector<double> commands(GetParam().channels, pressure_kpa);
    return board_->exchange(commands, readings_, generous);
  }
  /// Exchanges commands and readings for `duration`. Returns false if an exchange fails.
  bool hold(double pressure_kpa, std::chrono::milliseconds duration) {
    const auto end = std::chrono::steady_clock::now() + duration;
    while (std::chrono::steady_clock::now() < end) {
      if (exchange(pressure_kpa) != BusStatus::ok) return false;
      std::this_thread::sleep_for(10ms);
    }
    return true;
  }

  std::unique_ptr<test::RunningRig> rig_;
  std::unique_ptr<drivers::ModbusBoard> board_;
  std::vector<model::Reading> readings_;
};

TEST_P(ShippedBoard, ACommandMovesTheFingerOfTheSameChannel) {
  ASSERT_TRUE(hold(0, 100ms)) << board_->detail();
  const double at_rest_mm = readings_[0].displacement_mm;
  ASSERT_TRUE(hold(40, 2500ms)) << board_->detail();
  const std::vector<model::Reading> last = readings_;
  const Emulator& truth = rig_->stop();
  for (std::size_t i = 0; i < last.size(); ++i) {
    const simulation::Plant& plant = truth.fingers()[i].plant();
    EXPECT_EQ(last[i].validity, model::Validity::valid);
    EXPECT_GT(last[i].displacement_mm, at_rest_mm + 5) << "the finger must move by more than 5 mm";
    // The tolerance is half a step of the input with the lowest resolution (12 bits over 50 mm), plus the
    // motion of the finger since the reading.
    EXPECT_NEAR(last[i].displacement_mm, plant.displacement_mm(), 0.05);
    EXPECT_NEAR(plant.held_command_kpa(), 40, 0.02)
        << "the tolerance is half a step of an output with 12 bits over 100 kPa";
    if (rig_->board().wiring[i].pressure.has_value()) {
      EXPECT_NEAR(last[i].pressure_kpa, plant.pressure_kpa(), 0.1);
    }
    if (output_map().read_back.has_value()) {
      EXPECT_NEAR(last[i].command_readback_kpa, 40, 0.03);
    }
  }
}

TEST_P(ShippedBoard, AZeroCommandGivesZeroPressure) {
  ASSERT_TRUE(hold(30, 300ms)) << board_->detail();
  ASSERT_TRUE(hold(0, 100ms)) << board_->detail();
  for (const Finger& finger : rig_->stop().fingers()) {
    EXPECT_NEAR(finger.plant().held_command_kpa(), 0, 0.013)
        << "with festo-pgva, 0 kPa is the raw value 2047.5, which is rounded";
  }
}

TEST_P(ShippedBoard, AWatchdogTripIsReportedUntilANewSession) {
  const drivers::BoardWatchdog& watchdog = output_map().watchdog;
  ASSERT_TRUE(hold(40, 300ms)) << board_->detail();
  std::this_thread::sleep_for(std::chrono::milliseconds(static_cast<int>(test_timeout_s * 2e3)));
  if (watchdog.kind == drivers::BoardWatchdog::Kind::none) {
    EXPECT_FALSE(board_->has_watchdog());
    EXPECT_EQ(exchange(40), BusStatus::ok) << board_->detail();
    EXPECT_EQ(rig_->stop().watchdog_trips(), 0U);
    return;
  }
  EXPECT_TRUE(board_->has_watchdog());
  if (!watchdog.tripped.has_value()) {
    EXPECT_EQ(rig_->stop().watchdog_trips(), 1U) << "this board does not report a trip";
    return;
  }
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(exchange(40), BusStatus::watchdog_tripped) << board_->detail();
  }
  ASSERT_EQ(board_->connect(generous), BusStatus::ok) << board_->detail();
  EXPECT_EQ(exchange(0), BusStatus::ok) << board_->detail();
  EXPECT_TRUE(hold(20, 100ms)) << board_->detail();
  const Emulator& truth = rig_->stop();
  EXPECT_EQ(truth.watchdog_trips(), 1U);
  EXPECT_FALSE(truth.tripped());
  EXPECT_NEAR(truth.fingers()[0].plant().held_command_kpa(), 20, 0.02);
}

TEST_P(ShippedBoard, AWatchdogTripBlocksTheOutputs) {
  const drivers::BoardWatchdog& watchdog = output_map().watchdog;
  if (!watchdog.tripped.has_value()) GTEST_SKIP() << "the board does not report a trip";
  ASSERT_TRUE(hold(40, 200ms)) << board_->detail();
  std::this_thread::sleep_for(std::chrono::milliseconds(static_cast<int>(test_timeout_s * 2e3)));
  for (int i = 0; i < 5; ++i) EXPECT_EQ(exchange(40), BusStatus::watchdog_tripped);
  const Emulator& truth = rig_->stop();
  EXPECT_TRUE(truth.tripped());
  EXPECT_EQ(truth.fingers()[0].plant().held_command_kpa(), 0);
}

std::string name_of_combination(const testing::TestParamInfo<Combination>& info) {
  std::string name;
  for (const std::string& board : info.param.boards) name += (name.empty() ? "" : "_and_") + board;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Boards, ShippedBoard, testing::ValuesIn(combinations()), name_of_combination);

TEST(ShippedBoards, AllAreTested) {
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().stem().string();
    const auto all = combinations();
    EXPECT_TRUE(std::any_of(all.begin(), all.end(), [&](const Combination& one) {
      return std::find(one.boards.begin(), one.boards.end(), name) != one.boards.end();
    })) << name;
  }
}

}  // namespace
}  // namespace softgrip::simulation::shipped_boards_test
