#include "simulation/plant/simulated_board.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "model/catalogue.h"
#include "model/file/model_file.h"

namespace softgrip::simulation::simulated_board_test {
using namespace drivers;
namespace {

using namespace std::chrono_literals;
using model::Validity;
using Kind = SimulatedEvent::Kind;

constexpr Nanoseconds period = 5'000'000;

SimulatedBoardSettings two_twins() {
  document::Problems problems;
  const auto model = model::load_model(SOFTGRIP_SOURCE_DIR "/config/models/bench_twin.yaml", problems);
  if (!model.has_value()) throw std::runtime_error(problems.format());
  SimulatedBoardSettings settings;
  for (const char* name : {"left", "right"}) {
    SimulatedChannel channel;
    channel.name = name;
    channel.plant.model = *model;
    channel.plant.sample_time_s = 0.005;
    channel.valve_max_kpa = 100;
    channel.sensor_min_mm = -5;
    channel.sensor_max_mm = 45;
    settings.channels.push_back(channel);
  }
  return settings;
}

class Rig {
 public:
  explicit Rig(const SimulatedBoardSettings& settings) : board(settings, clock) {
    clock.set(1'000'000'000);
    EXPECT_EQ(board.connect(1s), BusStatus::ok);
  }
  BusStatus exchange(double left, double right) {
    const std::array commands{left, right};
    const BusStatus status = board.exchange(commands, readings, 1ms);
    clock.advance(period);
    return status;
  }
  /// Exchanges commands and readings for `seconds`. Returns the status of the last exchange.
  BusStatus run(double seconds, double left, double right) {
    BusStatus status = BusStatus::ok;
    for (int i = 0; i < static_cast<int>(std::lround(seconds * 200)); ++i) status = exchange(left, right);
    return status;
  }

  VirtualClock clock;
  SimulatedBoard board;
  std::array<Reading, 2> readings;
};

TEST(SimulatedBoard, TheGainOfAFingerFollowsTheMeasuredTemperature) {
  SimulatedBoardSettings settings = two_twins();
  for (SimulatedChannel& channel : settings.channels) {
    const auto thermal = model::find_block("thermal_gain");
    ASSERT_TRUE(thermal);
    channel.plant.model = model::with_block(channel.plant.model, {*thermal, {0.01}});
  }
  settings.channels[0].plant.temperature_c = 30;
  settings.channels[0].measures_temperature = true;
  Rig rig(settings);
  ASSERT_EQ(rig.run(2, 30, 30), BusStatus::ok);
  EXPECT_EQ(rig.readings[0].temperature_c, 30);
  EXPECT_TRUE(std::isnan(rig.readings[1].temperature_c));
  EXPECT_NEAR(rig.readings[0].displacement_mm / rig.readings[1].displacement_mm, 1.1, 1e-9);
}

TEST(SimulatedBoard, TemperatureReadingsHaveTheGivenNoise) {
  SimulatedBoardSettings settings = two_twins();
  settings.channels[0].measures_temperature = true;
  settings.channels[0].plant.temperature_noise_c = 0.2;
  Rig rig(settings);
  double sum = 0, squares = 0;
  constexpr int count = 400;
  for (int i = 0; i < count; ++i) {
    ASSERT_EQ(rig.exchange(0, 0), BusStatus::ok);
    const double off = rig.readings[0].temperature_c - 20;
    sum += off / count;
    squares += off * off / count;
  }
  EXPECT_NEAR(sum, 0, 0.04);
  EXPECT_NEAR(std::sqrt(squares), 0.2, 0.03);
}

TEST(SimulatedBoard, MovesTheCommandedFingerAndReadsTheCommandBack) {
  SimulatedBoardSettings settings = two_twins();
  settings.channels[0].measures_pressure = true;
  Rig rig(settings);
  EXPECT_EQ(rig.board.describe(), "simulated board with 2 fingers");
  ASSERT_EQ(rig.run(2, 30, 0), BusStatus::ok);
  EXPECT_NEAR(rig.readings[0].pressure_kpa, 30, 1e-6);
  EXPECT_TRUE(std::isnan(rig.readings[1].pressure_kpa));
  EXPECT_EQ(rig.readings[0].command_readback_kpa, 30);
  EXPECT_GT(rig.readings[0].displacement_mm, 5);
  EXPECT_EQ(rig.readings[1].displacement_mm, 0);
  EXPECT_EQ(rig.readings[0].validity, Validity::valid);
  EXPECT_EQ(rig.readings[0].sequence, 400U);
  EXPECT_EQ(rig.readings[0].sampled_at, rig.clock.now() - period);
}

// In each exchange, the board first takes the readings and then applies the commands. Even a finger without
// latency therefore shows its motion only in the next exchange.
TEST(SimulatedBoard, AReadingPrecedesTheCommandOfTheSameExchange) {
  SimulatedBoardSettings settings = two_twins();
  for (SimulatedChannel& channel : settings.channels) {
    model::Model& model = channel.plant.model;
    model = model::without_block(model, model::find_block("transport_delay").value());
    model = model::without_block(model, model::find_block("valve_lag").value());
  }
  Rig rig(settings);
  ASSERT_EQ(rig.exchange(20, 20), BusStatus::ok);
  EXPECT_EQ(rig.readings[0].displacement_mm, 0);
  ASSERT_EQ(rig.exchange(20, 20), BusStatus::ok);
  EXPECT_GT(rig.readings[0].displacement_mm, 0.1);
}

TEST(SimulatedBoard, TheSameSeedGivesTheSameBits) {
  SimulatedBoardSettings settings = two_twins();
  for (SimulatedChannel& channel : settings.channels) {
    channel.plant.displacement_noise_mm = 0.05;
    channel.plant.seed = 9;
    channel.output_bits = 12;
    channel.input_bits = 16;
  }
  settings.events.push_back({.at_s = 0.5037, .kind = Kind::object, .object = PlantObject{4, 0.1}});
  Rig first(settings);
  Rig second(settings);
  for (int i = 0; i < 1000; ++i) {
    const double command = 30 + 25 * std::sin(i * 0.01);
    ASSERT_EQ(first.exchange(command, 60 - command), BusStatus::ok);
    ASSERT_EQ(second.exchange(command, 60 - command), BusStatus::ok);
    for (std::size_t c = 0; c < 2; ++c) {
      ASSERT_EQ(first.readings[c].displacement_mm, second.readings[c].displacement_mm) << i;
    }
  }
}

TEST(SimulatedBoard, QuantisesOutputsAndInputs) {
  SimulatedBoardSettings settings = two_twins();
  settings.channels[0].output_bits = 3;
  settings.channels[0].input_bits = 8;
  Rig rig(settings);
  ASSERT_EQ(rig.run(3, 40, 40), BusStatus::ok);
  EXPECT_DOUBLE_EQ(rig.readings[0].command_readback_kpa, 300.0 / 7);
  const double steps = (rig.readings[0].displacement_mm + 5) / (50.0 / 255);
  EXPECT_NEAR(steps, std::round(steps), 1e-9);
}

TEST(SimulatedBoard, AnObjectIsRemovedAtTheScheduledTime) {
  SimulatedBoardSettings settings = two_twins();
  settings.channels[0].plant.object = PlantObject{.position_mm = 4, .yielding = 0.05};
  settings.events.push_back({.at_s = 3, .kind = Kind::object, .channel = 0});
  Rig rig(settings);
  ASSERT_EQ(rig.run(3, 40, 40), BusStatus::ok);
  const double held = rig.readings[0].displacement_mm;
  const double free = rig.readings[1].displacement_mm;
  EXPECT_NEAR(held, 4 + (free - 4) * 0.05, 1e-9);
  ASSERT_EQ(rig.run(0.01, 40, 40), BusStatus::ok);
  EXPECT_NEAR(rig.readings[0].displacement_mm, rig.readings[1].displacement_mm, 1e-9);
}

// A simulated event must take effect at its scheduled time, even if no exchange happens at this time.
TEST(SimulatedBoard, EventsOccurAtTheScheduledTimeBetweenExchanges) {
  SimulatedBoardSettings settings = two_twins();
  settings.events.push_back(
      {.at_s = 1, .kind = Kind::line_fault, .line = {.kind = LineFault::Kind::leaking, .share = 0.5}});
  Rig often(settings);
  Rig seldom(settings);
  ASSERT_EQ(often.run(0.1, 30, 30), BusStatus::ok);
  ASSERT_EQ(seldom.run(0.1, 30, 30), BusStatus::ok);
  ASSERT_EQ(often.run(1.1, 30, 30), BusStatus::ok);
  seldom.clock.advance(Nanoseconds{1'095'000'000});
  ASSERT_EQ(often.exchange(30, 30), BusStatus::ok);
  seldom.clock.set(often.clock.now() - period);
  ASSERT_EQ(seldom.exchange(30, 30), BusStatus::ok);
  EXPECT_NEAR(often.readings[0].displacement_mm, seldom.readings[0].displacement_mm, 1e-6);
}

TEST(SimulatedBoard, SensorFaultsMakeTheReadingOutOfRange) {
  SimulatedBoardSettings settings = two_twins();
  settings.events.push_back(
      {.at_s = 1, .kind = Kind::sensor_fault, .channel = 1, .sensor = {SensorFault::Kind::out_of_range, 0}});
  settings.events.push_back(
      {.at_s = 1, .kind = Kind::sensor_fault, .channel = 0, .sensor = {SensorFault::Kind::offset, 60}});
  Rig rig(settings);
  ASSERT_EQ(rig.run(1, 30, 30), BusStatus::ok);
  const double last = rig.readings[1].displacement_mm;
  ASSERT_EQ(rig.exchange(30, 30), BusStatus::ok);
  EXPECT_EQ(rig.readings[0].validity, Validity::out_of_range)
      << "with the offset the reading is beyond the sensor's range";
  EXPECT_EQ(rig.readings[1].validity, Validity::out_of_range);
  EXPECT_EQ(rig.readings[1].displacement_mm, last) << "the sensor repeats its last value";
}

TEST(SimulatedBoard, ALostBusEndsTheSessionUntilRestored) {
  SimulatedBoardSettings settings = two_twins();
  settings.events.push_back({.at_s = 1, .kind = Kind::bus_lost, .status = BusStatus::timed_out});
  settings.events.push_back({.at_s = 2, .kind = Kind::bus_lost, .status = BusStatus::disconnected});
  settings.events.push_back({.at_s = 3, .kind = Kind::bus_restored});
  Rig rig(settings);
  ASSERT_EQ(rig.run(1, 30, 30), BusStatus::ok);
  const std::uint32_t before = rig.readings[0].sequence;
  EXPECT_EQ(rig.exchange(30, 30), BusStatus::timed_out);
  EXPECT_EQ(rig.exchange(30, 30), BusStatus::disconnected) << "a timeout ends the session";
  EXPECT_EQ(rig.board.connect(1s), BusStatus::ok);
  EXPECT_EQ(rig.exchange(30, 30), BusStatus::timed_out);
  ASSERT_EQ(rig.run(1, 30, 30), BusStatus::disconnected);
  EXPECT_EQ(rig.board.connect(1s), BusStatus::disconnected);
  ASSERT_EQ(rig.run(1, 30, 30), BusStatus::disconnected);
  EXPECT_EQ(rig.board.connect(1s), BusStatus::ok);
  EXPECT_EQ(rig.readings[0].sequence, before) << "readings change only if the status is ok";
  EXPECT_EQ(rig.exchange(30, 30), BusStatus::ok);
}

TEST(SimulatedBoard, TheWatchdogVentsUntilANewConnection) {
  SimulatedBoardSettings settings = two_twins();
  settings.watchdog_timeout_s = 0.2;
  Rig rig(settings);
  EXPECT_TRUE(rig.board.has_watchdog());
  ASSERT_EQ(rig.run(2, 40, 40), BusStatus::ok);
  rig.clock.advance(3'000'000'000);  // 3 s pass without a request
  EXPECT_EQ(rig.exchange(40, 40), BusStatus::watchdog_tripped);
  EXPECT_NEAR(rig.board.plant(0).pressure_kpa(), 0, 1e-6);
  EXPECT_EQ(rig.run(1, 40, 40), BusStatus::watchdog_tripped);
  EXPECT_NEAR(rig.board.plant(0).pressure_kpa(), 0, 1e-6) << "exchanges alone do not change the outputs";
  ASSERT_EQ(rig.board.connect(1s), BusStatus::ok);
  EXPECT_EQ(rig.run(1, 10, 10), BusStatus::ok);
  EXPECT_NEAR(rig.board.plant(0).pressure_kpa(), 10, 1e-6);
}

TEST(SimulatedBoard, ExchangesAtTheWatchdogTimeCauseNoTrip) {
  SimulatedBoardSettings settings = two_twins();
  settings.watchdog_timeout_s = 0.005;  // watchdog time-out [s], equal to the time between two exchanges
  Rig rig(settings);
  EXPECT_EQ(rig.run(1, 20, 20), BusStatus::ok);
}

TEST(SimulatedBoard, ReportsAndLimitsCommandsOutsideTheRange) {
  Rig rig(two_twins());
  EXPECT_EQ(rig.exchange(100, 0), BusStatus::ok);
  EXPECT_EQ(rig.exchange(50, 101), BusStatus::write_refused);
  EXPECT_NE(std::string(rig.board.detail()).find("right"), std::string::npos);
  EXPECT_EQ(rig.board.plant(1).held_command_kpa(), 100);
  EXPECT_EQ(rig.exchange(-1, 0), BusStatus::write_refused);
  EXPECT_EQ(rig.exchange(std::numeric_limits<double>::quiet_NaN(), 70), BusStatus::write_refused);
  EXPECT_EQ(rig.board.plant(1).held_command_kpa(), 0) << "no output is written if a command is not a number";
}

TEST(SimulatedBoard, ReportsAnOutputThatDiffersFromTheCommand) {
  SimulatedBoardSettings settings = two_twins();
  settings.events.push_back({.at_s = 1, .kind = Kind::write_refused});
  settings.events.push_back({.at_s = 2, .kind = Kind::write_taken});
  Rig rig(settings);
  ASSERT_EQ(rig.run(1, 30, 30), BusStatus::ok);
  EXPECT_EQ(rig.exchange(30, 30), BusStatus::ok) << "the output still equals the command";
  EXPECT_EQ(rig.exchange(0, 30), BusStatus::write_refused);
  EXPECT_EQ(rig.board.plant(0).held_command_kpa(), 30);
  rig.run(1, 0, 0);
  EXPECT_EQ(rig.exchange(0, 0), BusStatus::ok);
  EXPECT_EQ(rig.board.plant(0).held_command_kpa(), 0);
}

}  // namespace
}  // namespace softgrip::simulation::simulated_board_test
