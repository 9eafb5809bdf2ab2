#include "simulation/emulator/emulator.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "model/file/model_file.h"
#include "rig/board_map_file.h"
#include "simulation/emulator/finger.h"
#include "simulation/emulator/server.h"

namespace softgrip::simulation::emulator_test {
namespace {

constexpr Nanoseconds second = 1'000'000'000;
constexpr Nanoseconds millisecond = second / 1000;

FaultSpec fault(std::string name, FaultKind kind) {
  FaultSpec spec = fault_of(kind);
  spec.name = std::move(name);
  return spec;
}

/// An emulated ADAM-6024 with two fingers of the model bench_twin without noise. All requests have the
/// transaction id 7.
class EmulatorTest : public testing::Test {
 protected:
  static EmulatorSettings settings(std::vector<FaultSpec> faults = {}) {
    document::Problems problems;
    EmulatorSettings settings;
    const auto map = *rig::load_board_map(SOFTGRIP_SOURCE_DIR "/config/boards/adam-6024.yaml", problems);
    settings.modules = {{map, 1, 0}};
    settings.wiring = *default_wiring({&map, 1}, 2);
    settings.plants.resize(2);
    for (auto& plant : settings.plants) {
      plant.model = *model::load_model(SOFTGRIP_SOURCE_DIR "/config/models/bench_twin.yaml", problems);
    }
    settings.faults = std::move(faults);
    return settings;
  }

  static Reply ask(Emulator& emulator, Nanoseconds now, Bytes pdu, std::uint8_t unit = 1) {
    return emulator.serve(now, {7, unit, std::move(pdu)});
  }
  /// Commands the same pressure for both valves. Returns true if the board has responded.
  static bool command(Emulator& emulator, Nanoseconds now, double pressure_kpa) {
    const auto raw = static_cast<std::uint16_t>(pressure_kpa / 100 * 4095);
    Bytes pdu{0x10, 0, 10, 0, 2, 4};
    append_word(pdu, raw);
    append_word(pdu, raw);
    return !ask(emulator, now, pdu).pieces.empty();
  }
  static double reading_mm(Emulator& emulator, Nanoseconds now, std::uint8_t channel) {
    const Reply reply = ask(emulator, now, {0x04, 0, channel, 0, 1});
    EXPECT_EQ(reply.pieces.size(), 1U);
    const double volts = word_at(reply.pieces.at(0).bytes, 9) * 20.0 / 65535 - 10;
    return volts / 10 * 50 - 5;
  }
  /// Sends requests until the time `until`, at intervals of at most 0.1 s, so that the watchdog does not
  /// trip.
  static void keep_alive(Emulator& emulator, Nanoseconds until) {
    while (emulator.now() < until) {
      (void)ask(emulator, std::min(until, emulator.now() + second / 10), {0x04, 0, 0, 0, 1});
    }
  }
};

TEST_F(EmulatorTest, TheFingerFollowsTheCommand) {
  Emulator emulator(settings());
  command(emulator, 0, 40);
  keep_alive(emulator, 5 * second);
  EXPECT_NEAR(emulator.fingers()[0].plant().pressure_kpa(), 40, 0.05)
      << "the output has 12 bits over 100 kPa";
  EXPECT_GT(emulator.fingers()[0].plant().displacement_mm(), 10);
  EXPECT_NEAR(reading_mm(emulator, 5 * second, 0), emulator.fingers()[0].plant().displacement_mm(), 0.002);
  EXPECT_NEAR(reading_mm(emulator, 5 * second, 1), emulator.fingers()[1].plant().displacement_mm(), 0.002);
}

TEST_F(EmulatorTest, TheMotionIsIndependentOfTheRequestRate) {
  Emulator often(settings());
  Emulator seldom(settings());
  for (Emulator* emulator : {&often, &seldom}) command(*emulator, 0, 40);
  for (Nanoseconds now = 0; now < 2 * second; now += 700'001) (void)ask(often, now, {0x04, 0, 0, 0, 1});
  keep_alive(seldom, 2 * second);
  often.advance(2 * second);
  EXPECT_NEAR(often.fingers()[0].plant().displacement_mm(), seldom.fingers()[0].plant().displacement_mm(),
              1e-9);
}

TEST_F(EmulatorTest, VentsAfterTheWatchdogTimeWithoutRequests) {
  Emulator emulator(settings());
  command(emulator, 0, 40);
  emulator.advance(second / 2 - 1);
  EXPECT_GT(emulator.fingers()[0].plant().held_command_kpa(), 39);
  emulator.advance(second / 2);
  EXPECT_EQ(emulator.fingers()[0].plant().held_command_kpa(), 0);
  EXPECT_EQ(emulator.watchdog_trips(), 1U);
}

TEST_F(EmulatorTest, AnotherUnitIdReceivesAnException) {
  Emulator emulator(settings());
  EXPECT_EQ(ask(emulator, 0, {0x04, 0, 0, 0, 1}, 2).pieces.at(0).bytes,
            (Bytes{0, 7, 0, 0, 0, 3, 2, 0x84, 11}));
}

TEST_F(EmulatorTest, ALostRequestHasNoEffectOnOutputsAndWatchdog) {
  Emulator emulator(settings({fault("cut", FaultKind::lost_request)}));
  command(emulator, 0, 40);
  EXPECT_TRUE(emulator.trigger("cut", second / 10));
  EXPECT_FALSE(command(emulator, second / 5, 10));
  EXPECT_GT(emulator.fingers()[0].plant().held_command_kpa(), 39);
  emulator.advance(second);
  EXPECT_TRUE(emulator.tripped());
}

TEST_F(EmulatorTest, ARequestWithALostResponseIsExecuted) {
  Emulator emulator(settings({fault("mute", FaultKind::no_reply)}));
  emulator.trigger("mute", 0);
  EXPECT_FALSE(command(emulator, 0, 40));
  EXPECT_GT(emulator.fingers()[0].plant().held_command_kpa(), 39);
}

TEST_F(EmulatorTest, ADisconnectFaultRefusesClients) {
  Emulator emulator(settings({fault("cut", FaultKind::disconnect)}));
  EXPECT_TRUE(emulator.reachable());
  emulator.trigger("cut", 0);
  EXPECT_FALSE(emulator.reachable());
  EXPECT_TRUE(ask(emulator, 0, {0x04, 0, 0, 0, 1}).disconnect);
  emulator.clear("cut", 0);
  EXPECT_TRUE(emulator.reachable());
}

TEST_F(EmulatorTest, ScheduledFaultsCountFromTheFirstCommand) {
  FaultSpec mute = fault("mute", FaultKind::no_reply);
  mute.at_s = 1;
  mute.for_s = 0.5;
  Emulator emulator(settings({mute}));
  keep_alive(emulator, 10 * second);
  EXPECT_TRUE(command(emulator, 10 * second, 10));
  EXPECT_TRUE(command(emulator, 11 * second - 1, 10));
  EXPECT_FALSE(command(emulator, 11 * second, 10));
  EXPECT_FALSE(command(emulator, 11 * second + 499 * millisecond, 10));
  EXPECT_TRUE(command(emulator, 11 * second + 500 * millisecond, 10));
}

TEST_F(EmulatorTest, AStuckSensorAffectsOnlyOneChannel) {
  FaultSpec stuck = fault("stuck", FaultKind::sensor_stuck);
  stuck.channel = 1;
  Emulator emulator(settings({stuck}));
  command(emulator, 0, 20);
  keep_alive(emulator, second);
  const double before_mm = reading_mm(emulator, second, 1);
  emulator.trigger("stuck", second);
  command(emulator, second, 50);
  keep_alive(emulator, 2 * second);
  EXPECT_EQ(reading_mm(emulator, 2 * second, 1), before_mm);
  EXPECT_GT(reading_mm(emulator, 2 * second, 0), before_mm + 3)
      << "the sensor without the fault still measures";
  emulator.clear("stuck", 2 * second);
  emulator.advance(2 * second + millisecond);
  EXPECT_GT(reading_mm(emulator, 2 * second + millisecond, 1), before_mm + 3);
}

TEST_F(EmulatorTest, AJumpingSensorAlternatesBetweenTwoValues) {
  FaultSpec jumping = fault("jumping", FaultKind::sensor_jumping);
  jumping.sensor.value_mm = 4;
  jumping.interval_s = 0.1;
  Emulator emulator(settings({jumping}));
  emulator.trigger("jumping", 0);
  EXPECT_NEAR(reading_mm(emulator, 50 * millisecond, 0), 4, 0.01);
  EXPECT_NEAR(reading_mm(emulator, 150 * millisecond, 0), 0, 0.01);
  EXPECT_NEAR(reading_mm(emulator, 250 * millisecond, 0), 4, 0.01);
}

TEST_F(EmulatorTest, AnOutOfRangeSensorShowsTheUpperLimitAndTheStatus) {
  Emulator emulator(settings({fault("blind", FaultKind::sensor_out_of_range)}));
  emulator.trigger("blind", 0);
  emulator.advance(millisecond);
  EXPECT_NEAR(reading_mm(emulator, millisecond, 0), 45, 0.01);
  EXPECT_EQ(ask(emulator, millisecond, {0x04, 0, 20, 0, 1}).pieces.at(0).bytes.back(), 1)
      << "the input status must be 1, which means above the range";
}

TEST_F(EmulatorTest, ALineFaultBlocksOrReducesThePressure) {
  FaultSpec leaking = fault("leaking", FaultKind::line_leaking);
  leaking.line.share = 0.25;
  leaking.channel = 0;
  FaultSpec blocked = fault("blocked", FaultKind::line_blocked);
  blocked.channel = 1;
  Emulator emulator(settings({leaking, blocked}));
  command(emulator, 0, 40);
  keep_alive(emulator, second);
  emulator.trigger("leaking", second);
  emulator.trigger("blocked", second);
  command(emulator, second, 20);
  keep_alive(emulator, 3 * second);
  EXPECT_NEAR(emulator.fingers()[0].plant().pressure_kpa(), 15, 0.1);
  EXPECT_NEAR(emulator.fingers()[1].plant().pressure_kpa(), 40, 0.1);
}

TEST_F(EmulatorTest, AnObjectLimitsTheMotionUntilRemoved) {
  Emulator free_emulator(settings());
  EmulatorSettings with_object = settings();
  for (auto& plant : with_object.plants) plant.object = object_named("10:0.1");
  Emulator emulator(std::move(with_object));
  for (Emulator* each : {&free_emulator, &emulator}) {
    command(*each, 0, 45);
    keep_alive(*each, 3 * second);
  }
  const double free_mm = free_emulator.fingers()[0].plant().displacement_mm();
  const double held_mm = emulator.fingers()[0].plant().displacement_mm();
  EXPECT_NEAR(held_mm, 10 + 0.1 * (free_mm - 10), 1e-6);
  EXPECT_TRUE(emulator.trigger(Emulator::object_out, 3 * second));
  EXPECT_FALSE(emulator.fingers()[0].has_object());
  emulator.advance(3 * second + millisecond);
  EXPECT_NEAR(emulator.fingers()[0].plant().displacement_mm(), free_mm, 0.01);
}

TEST_F(EmulatorTest, ExecutesAndChecksControlCommands) {
  Emulator emulator(settings({fault("mute", FaultKind::no_reply)}));
  EXPECT_EQ(control(emulator, 0, "fault mute").line, "ok");
  auto status = nlohmann::json::parse(control(emulator, second, "status").line);
  EXPECT_EQ(status["faults"], nlohmann::json::array({"mute"}));
  EXPECT_EQ(status["time_s"], 1.0);
  EXPECT_EQ(status["channels"].size(), 2U);
  EXPECT_EQ(control(emulator, second, "clear mute").line, "ok");
  EXPECT_EQ(control(emulator, second, "object 12:0.2").line, "ok");
  EXPECT_EQ(emulator.fingers()[1].plant().object(), (simulation::PlantObject{12, 0.2}));
  EXPECT_EQ(control(emulator, second, "object out").line, "ok");
  EXPECT_FALSE(emulator.fingers()[1].has_object());
  EXPECT_EQ(control(emulator, second, "object back").line, "ok");
  EXPECT_TRUE(emulator.fingers()[1].has_object());
  EXPECT_TRUE(control(emulator, second, "quit").quit);
  for (const char* nonsense : {"", "fault", "fault x", "object", "object heavy", "object 12:2", "hello"}) {
    EXPECT_EQ(control(emulator, second, nonsense).line.substr(0, 6), "error:") << nonsense;
  }
}

TEST_F(EmulatorTest, BoardsWithoutEnoughTerminalsAreRefused) {
  const drivers::BoardMap map = settings().modules[0].map;
  EXPECT_FALSE(default_wiring({&map, 1}, 3));
  EXPECT_FALSE(default_wiring({&map, 1}, 0));
  EXPECT_TRUE(drivers::wiring_problems(map, *default_wiring({&map, 1}, 2)).empty());
}

}  // namespace
}  // namespace softgrip::simulation::emulator_test
