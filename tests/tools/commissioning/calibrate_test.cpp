// Tests softgrip calibrate with simulated rigs. The true scalings of these rigs are known.

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "rig/rig_file.h"
#include "simulation/plant/simulated_board.h"
#include "tests/daemon/rig_under_test.h"
#include "tests/support/files.h"
#include "tests/tools/passing_board.h"
#include "tests/tools/virtual_time.h"
#include "tools/commissioning/calibration_results.h"
#include "tools/commissioning/line_fit.h"
#include "tools/commissioning/procedure.h"

namespace softgrip::tools::calibrate::calibrate_test {
namespace {

/// Returns four visits (measurements at a position), two at each of two positions. Apart from small
/// deviations, the visits lie on the line y = 3 - 2 x.
std::vector<Visit> visits() {
  std::vector<Visit> list;
  for (const double off : {0.001, -0.001}) {
    list.push_back({false, 1, 0.002, 0, 400, 1 + off});
    list.push_back({true, 6, 0.002, 0, 400, -9 + off});
  }
  return list;
}
constexpr Demands demands{1, 0.2};

TEST(FitLine, ReturnsSlopeResidualsRepeatabilityAndNoise) {
  const auto line = fit_line(visits(), demands, "mm", "V");
  ASSERT_TRUE(line) << line.error();
  EXPECT_NEAR(line->slope, -2, 1e-12);
  EXPECT_NEAR(line->points.y_at(3.5), 3 - 7, 1e-12);
  ASSERT_EQ(line->residuals.size(), 4U);
  EXPECT_NEAR(line->residuals[0], 0.001, 1e-12);
  EXPECT_NEAR(line->residuals[2], -0.001, 1e-12);
  EXPECT_NEAR(line->repeat_spread.value_or(0), 0.002, 1e-12);
  EXPECT_NEAR(line->noise, 0.004, 1e-12);
}

TEST(FitLine, ReturnsNoRepeatabilityWithoutRepetition) {
  std::vector<Visit> two = visits();
  two.resize(2);
  const auto line = fit_line(two, demands, "mm", "V");
  ASSERT_TRUE(line);
  EXPECT_FALSE(line->repeat_spread);
  EXPECT_NEAR(line->residuals[0], 0, 1e-12);
}

TEST(FitLine, RefusesUnusableVisitsAndStatesTheReason) {
  const auto why = [](const std::function<void(std::vector<Visit>&)>& spoil) {
    std::vector<Visit> list = visits();
    spoil(list);
    const auto line = fit_line(list, demands, "mm", "V");
    return line ? std::string("accepted") : line.error();
  };
  EXPECT_EQ(why([](auto&) {}), "accepted");
  EXPECT_NE(why([](auto& list) { list[1].reference = list[3].reference = 1.5; }).find("too close"),
            std::string::npos);
  EXPECT_NE(why([](auto& list) { list[1].electrical = list[3].electrical = 1.1; }).find("changes too little"),
            std::string::npos);
  EXPECT_NE(why([](auto& list) { list[2].noise = 0.2; }).find("too much noise"), std::string::npos);
  EXPECT_NE(why([](auto& list) { list[2].drift = 0.3; }).find("too much drift"), std::string::npos);
  EXPECT_NE(why([](auto& list) { list[2].reference = 3; }).find("not repeatable"), std::string::npos);
  EXPECT_NE(why([](auto& list) { list[0].reference = NAN; }).find("not a number"), std::string::npos);
  EXPECT_NE(why([](auto& list) { list.resize(1); }).find("two different positions"), std::string::npos);
}

TEST(FindDeadZone, FindsTheEndAndGainOfANoisyDeadZone) {
  constexpr std::uint64_t seed = 7;
  SCOPED_TRACE(seed);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0, 0.1);
  std::vector<double> command;
  std::vector<double> response;
  for (int i = 0; i < 2000; ++i) {
    command.push_back(i * 0.01);
    response.push_back(std::max(0.0, command.back() - 3.2) + 0.4 + noise(random));
  }
  const auto zone = find_dead_zone(command, response);
  ASSERT_TRUE(zone);
  EXPECT_TRUE(zone->significant);
  EXPECT_NEAR(zone->end, 3.2, 0.1);
  EXPECT_NEAR(zone->gain, 1, 0.02);
}

TEST(FindDeadZone, ReportsNoDeadZoneForAProportionalResponse) {
  std::mt19937_64 random(8);
  std::normal_distribution<double> noise(0, 0.1);
  std::vector<double> command;
  std::vector<double> response;
  std::vector<double> nothing;
  for (int i = 0; i < 2000; ++i) {
    command.push_back(i * 0.01);
    response.push_back(command.back() + noise(random));
    nothing.push_back(noise(random));
  }
  const auto zone = find_dead_zone(command, response);
  ASSERT_TRUE(zone);
  EXPECT_FALSE(zone->significant);
  EXPECT_FALSE(find_dead_zone(command, nothing))
      << "the measured signal does not follow the ramp, so there is no dead zone to find";
}

/// Simulates an operator who reads the gauge. The gauge shows the true position of the simulated finger.
class KnowingOperator final : public Operator {
 public:
  explicit KnowingOperator(std::function<std::string()> reading) : reading_(std::move(reading)) {}
  void tell(const std::string& text) override { told.push_back(text); }
  void ask(const std::string& question) override {
    asked.push_back(question);
    waited_ = 0;
  }
  std::optional<std::string> answer() override {
    // The operator needs time to answer. Meanwhile, the session must continue to communicate with the board.
    if (++waited_ < 300) return std::nullopt;
    return reading_();
  }
  [[nodiscard]] bool gone() const override { return false; }
  [[nodiscard]] bool patient() const override { return false; }

  std::vector<std::string> asked;
  std::vector<std::string> told;

 private:
  std::function<std::string()> reading_;
  int waited_ = 0;
};

/// A board that forwards all exchanges to another board and records the highest command.
class WatchedBoard final : public testing::PassingBoard {
 public:
  using PassingBoard::PassingBoard;
  [[nodiscard]] drivers::BusStatus exchange(std::span<const double> commands_kpa,
                                            std::span<model::Reading> readings,
                                            std::chrono::nanoseconds deadline) noexcept override {
    highest_kpa = std::max(highest_kpa, *std::max_element(commands_kpa.begin(), commands_kpa.end()));
    const drivers::BusStatus status = PassingBoard::exchange(commands_kpa, readings, deadline);
    if (!monitored) readings[0].pressure_kpa = std::numeric_limits<double>::quiet_NaN();
    if (at_kpa > 0 && std::abs(commands_kpa[0] - at_kpa) < 0.01) ++exchanges_at;
    if (exchanges_at >= refused_from && exchanges_at < refused_to) return drivers::BusStatus::exception;
    readings[0].pressure_kpa += drift_kpa * static_cast<double>(exchanges_at);
    return status;
  }

  double at_kpa = 0;             ///< command at which exchanges are counted; 0: no exchanges are counted
  std::size_t exchanges_at = 0;  ///< number of counted exchanges
  std::size_t refused_from = 0;  ///< number of the first counted exchange that the board refuses
  std::size_t refused_to = 0;    ///< number of the first counted exchange after refused_from that succeeds
  double drift_kpa = 0;          ///< increase of the left pressure reading with each counted exchange [kPa]
  double highest_kpa = 0;
  bool monitored = true;  ///< false: the left pressure monitor gives no readings
};

class CalibrateTest : public ::testing::Test {
 protected:
  CalibrateTest() {
    for (simulation::SimulatedChannel& channel : simulated().channels) channel.plant.object.reset();
    settings_.may_move = true;
    settings_.low_kpa = 10;
    settings_.high_kpa = 40;
    settings_.repeats = 2;
  }
  simulation::SimulatedBoardSettings& simulated() {
    return std::get<simulation::SimulatedBoardSettings>(rig_.board);
  }
  void sensor_fault(simulation::SensorFault::Kind kind) {
    simulation::SimulatedEvent event;
    event.kind = simulation::SimulatedEvent::Kind::sensor_fault;
    event.sensor.kind = kind;
    simulated().events.push_back(event);
  }
  /// Calibrates the sensor with an operator who knows the true displacement.
  auto calibrate_with_the_truth() {
    make();
    KnowingOperator person([this] { return truth_mm(); });
    return calibrate_sensor(rig_, *session_, person, settings_);
  }
  void make() {
    board_ = std::make_unique<simulation::SimulatedBoard>(simulated(), time_.clock);
    session_ = std::make_unique<MotionSession>(rig_, *board_, time_.clock, time_.stop());
    ASSERT_TRUE(session_->connect());
  }
  [[nodiscard]] std::string truth_mm() { return std::to_string(board_->plant(0).displacement_mm()); }
  [[nodiscard]] std::string truth_kpa() { return std::to_string(board_->plant(0).pressure_kpa()); }

  rig::RigFile rig_ = daemon::testing::example_rig("rig.yaml");
  testing::VirtualTime time_;
  Settings settings_;
  std::unique_ptr<simulation::SimulatedBoard> board_;
  std::unique_ptr<MotionSession> session_;
};

TEST_F(CalibrateTest, RecoversTheSensorScalingWithinTheStatedError) {
  for (const drivers::TwoPoints& truth :
       {drivers::TwoPoints{0, -5, 10, 45}, drivers::TwoPoints{0.5, 45, 9.5, -5}}) {
    time_.clock.set(1'000'000'000);
    rig_.wiring[0].displacement.scaling = truth;
    make();
    KnowingOperator person([this] { return truth_mm(); });
    const auto line = calibrate_sensor(rig_, *session_, person, settings_);
    ASSERT_TRUE(line) << line.error().text;
    EXPECT_EQ(line->slope > 0, truth.y1 > truth.y0);
    for (const double x : {line->points.x0, line->points.x1}) {
      EXPECT_NEAR(line->points.y_at(x), truth.y_at(x), line->error) << "stated " << line->error;
    }
    EXPECT_LT(line->error, 0.5) << "the stated error of the calibration must be small";
    EXPECT_EQ(person.asked.size(), 4U);
    session_.reset();
    EXPECT_EQ(board_->plant(0).held_command_kpa(), 0) << "the session ended with safe outputs";
  }
}

TEST_F(CalibrateTest, RecoversTheValveScalingByMonitorAndByManometer) {
  make();
  KnowingOperator person([this] { return truth_kpa(); });
  for (const bool by_monitor : {true, false}) {
    const auto result = calibrate_valve(rig_, *session_, person, settings_, by_monitor);
    ASSERT_TRUE(result) << result.error().text;
    for (const double x : {result->valve.points.x0, result->valve.points.x1}) {
      EXPECT_NEAR(result->valve.points.y_at(x), rig_.wiring[0].valve.scaling.y_at(x),
                  std::max(result->valve.error, 0.05))
          << "the simulated valve is ideal";
    }
    EXPECT_EQ(result->monitor.has_value(), !by_monitor);
  }
}

/// The board refuses all exchanges during the first or the second half of the averaging time. Without a
/// reading, the mean of this half would be 0 kPa.
TEST_F(CalibrateTest, RefusesAPressureMonitorWithoutReadingsInHalfOfTheAveragingTime) {
  settings_.settle_s = 1;
  settings_.average_s = 0.2;
  rig_.settings.faults.bus_down_cycles = 60;
  const std::size_t settled = 200, half = 20;
  for (const std::size_t first : {settled - 4, settled + half - 2}) {
    SCOPED_TRACE(first);
    time_.clock.set(1'000'000'000);
    simulation::SimulatedBoard plants(simulated(), time_.clock);
    WatchedBoard board(plants);
    board.at_kpa = settings_.low_kpa;
    board.refused_from = first;
    board.refused_to = first + half + 8;
    MotionSession session(rig_, board, time_.clock, time_.stop());
    ASSERT_TRUE(session.connect());
    KnowingOperator person([] { return ""; });
    const auto result = calibrate_valve(rig_, session, person, settings_, true);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ExitCode::not_acceptable);
    EXPECT_NE(result.error().text.find("no valid reading in half of the averaging time"), std::string::npos)
        << result.error().text;
  }
}

TEST_F(CalibrateTest, RefusesADriftingPressureMonitor) {
  for (const double drift_kpa : {0.001, 0.009}) {
    SCOPED_TRACE(drift_kpa);
    time_.clock.set(1'000'000'000);
    simulation::SimulatedBoard plants(simulated(), time_.clock);
    WatchedBoard board(plants);
    board.at_kpa = settings_.low_kpa;
    board.drift_kpa = drift_kpa;
    MotionSession session(rig_, board, time_.clock, time_.stop());
    ASSERT_TRUE(session.connect());
    KnowingOperator person([] { return ""; });
    settings_.repeats = 1;
    const auto result = calibrate_valve(rig_, session, person, settings_, true);
    if (drift_kpa < 0.002) {
      EXPECT_TRUE(result) << result.error().text;
      continue;
    }
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ExitCode::not_acceptable);
    EXPECT_NE(result.error().text.find("valve: too much drift"), std::string::npos) << result.error().text;
  }
}

TEST_F(CalibrateTest, FindsNoDeadZoneInAnIdealValve) {
  make();
  KnowingOperator person([] { return ""; });
  const auto result = search_dead_zone(rig_, *session_, person, settings_);
  ASSERT_TRUE(result) << result.error().text;
  EXPECT_TRUE(result->by_pressure);
  EXPECT_LT(result->zone->end, 1);
}

TEST_F(CalibrateTest, RefusesASensorThatIsSaturatedOrOutOfRange) {
  sensor_fault(simulation::SensorFault::Kind::out_of_range);
  const auto line = calibrate_with_the_truth();
  ASSERT_FALSE(line);
  EXPECT_EQ(line.error().code, ExitCode::not_acceptable);
  EXPECT_NE(line.error().text.find("not valid (out_of_range)"), std::string::npos) << line.error().text;
}

/// If a sensor that a procedure needs gives no valid reading, the procedure must not raise the pressure.
TEST_F(CalibrateTest, DoesNotRaiseThePressureWithoutTheRequiredSensor) {
  using Procedure = std::function<std::optional<Refusal>(MotionSession&, Operator&)>;
  const auto refusal = [](const auto& result) {
    return result ? std::nullopt : std::optional<Refusal>(result.error());
  };
  const std::vector<Procedure> all{[&](MotionSession& session, Operator& person) {
                                     return refusal(calibrate_valve(rig_, session, person, settings_, true));
                                   },
                                   [&](MotionSession& session, Operator& person) {
                                     return refusal(search_dead_zone(rig_, session, person, settings_));
                                   },
                                   [&](MotionSession& session, Operator& person) {
                                     return refusal(calibrate_valve(rig_, session, person, settings_, false));
                                   },
                                   [&](MotionSession& session, Operator& person) {
                                     return refusal(calibrate_sensor(rig_, session, person, settings_));
                                   }};
  KnowingOperator person([] { return "1"; });
  for (const bool monitor : {false, true}) {
    // Without the monitor, test only the first two procedures, because only these two need the pressure
    // monitor.
    for (std::size_t i = 0; i < (monitor ? 2 : all.size()); ++i) {
      SCOPED_TRACE(std::to_string(i) + (monitor ? " without the monitor" : " without the sensor"));
      simulated().events.clear();
      if (!monitor) sensor_fault(simulation::SensorFault::Kind::out_of_range);
      time_.clock.set(1'000'000'000);
      simulation::SimulatedBoard plants(simulated(), time_.clock);
      WatchedBoard board(plants);
      board.monitored = !monitor;
      MotionSession session(rig_, board, time_.clock, time_.stop());
      ASSERT_TRUE(session.connect());
      const auto why = all[i](session, person);
      ASSERT_TRUE(why.has_value());
      EXPECT_EQ(why->code, ExitCode::not_acceptable);
      EXPECT_NE(why->text.find("are not valid"), std::string::npos) << why->text;
      EXPECT_EQ(board.highest_kpa, 0);
    }
  }
}

TEST_F(CalibrateTest, RefusesAStuckDisplacementSensor) {
  sensor_fault(simulation::SensorFault::Kind::stuck);
  const auto line = calibrate_with_the_truth();
  ASSERT_FALSE(line);
  EXPECT_NE(line.error().text.find("changes too little"), std::string::npos) << line.error().text;
}

TEST_F(CalibrateTest, RefusesANonNumericAnswerAndVents) {
  make();
  KnowingOperator person([] { return "about ten"; });
  const auto line = calibrate_sensor(rig_, *session_, person, settings_);
  ASSERT_FALSE(line);
  EXPECT_EQ(line.error().code, ExitCode::input_refused);
  session_.reset();
  EXPECT_EQ(board_->plant(0).held_command_kpa(), 0);
}

TEST_F(CalibrateTest, VentsIfStoppedByTheUser) {
  time_.stop_at = 4'000'000'000;
  const auto line = calibrate_with_the_truth();
  ASSERT_FALSE(line);
  EXPECT_EQ(line.error().text, "stopped by the user");
  EXPECT_GT(board_->plant(0).held_command_kpa(), 1) << "the command had begun to rise before the stop";
  EXPECT_TRUE(session_->leave());
  EXPECT_EQ(board_->plant(0).held_command_kpa(), 0);
}

TEST_F(CalibrateTest, NeverCommandsBeyondTheLimits) {
  settings_.high_kpa = 500;
  make();
  double highest = 0;
  KnowingOperator person([this] { return truth_mm(); });
  (void)session_->ramp(0, 500, 1e9,
                       [&](const auto& commands, const auto&) { highest = std::max(highest, commands[0]); });
  EXPECT_LE(highest, 60);
}

TEST_F(CalibrateTest, ManualSensorCalibrationDoesNotMoveTheFinger) {
  settings_.may_move = false;
  make();
  double place = 2;
  KnowingOperator person([&] {
    // The operator should move the target of the sensor by hand. Each time, the operator enters a position
    // that is 10 mm higher. The reading is constant, because the simulated finger does not move.
    return std::to_string(place += 10);
  });
  const auto line = calibrate_sensor(rig_, *session_, person, settings_);
  EXPECT_FALSE(line) << "the signal did not follow the gauge";
  EXPECT_EQ(board_->plant(0).pressure_kpa(), 0);
  EXPECT_NE(person.asked.front().find("put the target"), std::string::npos);
}

TEST_F(CalibrateTest, ReadsGaugePositionsFromTheOperatorWithoutMotion) {
  make();
  int answered = 0;
  KnowingOperator person([&]() -> std::string {
    const std::vector<std::string> answers{"", "12,5", "-", ""};
    return answers[static_cast<std::size_t>(answered++)];
  });
  const auto visits = read_positions(*session_, person, settings_, {0, 10, 20, 30});
  ASSERT_TRUE(visits) << visits.error().text;
  ASSERT_EQ(visits->size(), 3U) << "the operator skipped one of the measurements";
  EXPECT_EQ((*visits)[0].position_mm, 0) << "pressing Enter must confirm the requested position";
  EXPECT_EQ((*visits)[1].position_mm, 12.5);
  EXPECT_EQ((*visits)[2].position_mm, 30);
  for (const GaugeVisit& visit : *visits) {
    EXPECT_NEAR(visit.reading_mm, board_->plant(0).displacement_mm(), 0.02);
    EXPECT_GT(visit.count, 100U);
  }
  EXPECT_NE(person.asked[1].find("2 of 4: put the target of the sensor at 10 mm"), std::string::npos)
      << person.asked[1];
  EXPECT_EQ(board_->plant(0).pressure_kpa(), 0);
}

TEST_F(CalibrateTest, SkipsAGaugePositionWithoutAValidReading) {
  sensor_fault(simulation::SensorFault::Kind::out_of_range);
  make();
  KnowingOperator person([] { return ""; });
  const auto visits = read_positions(*session_, person, settings_, {0, 10});
  ASSERT_TRUE(visits) << visits.error().text;
  EXPECT_TRUE(visits->empty());
  EXPECT_NE(person.told.front().find("skipped"), std::string::npos);
}

TEST_F(CalibrateTest, AGaugeCheckStopsOnRequest) {
  time_.stop_at = 4'000'000'000;
  make();
  KnowingOperator person([] { return ""; });
  const auto visits = read_positions(*session_, person, settings_, {0, 10, 20, 30});
  ASSERT_FALSE(visits);
  EXPECT_EQ(visits.error().text, "stopped by the user");
}

TEST_F(CalibrateTest, TheSnippetIsAcceptedInARigFile) {
  make();
  KnowingOperator person([this] { return truth_mm(); });
  Results results;
  results.date = "2026-11-20";
  results.sensor = calibrate_sensor(rig_, *session_, person, settings_).value();
  results.valve = calibrate_valve(rig_, *session_, person, settings_, true).value();
  results.dead_zone = search_dead_zone(rig_, *session_, person, settings_).value();
  const std::string text = snippet(rig_, results);
  EXPECT_EQ(text.find("# softgrip calibrate, 2026-11-20: rig simulated, channel left"), 0U) << text;
  EXPECT_NE(text.find("the signal rises"), std::string::npos);
  EXPECT_NE(text.find("use 60 % of the valve's range\n"), std::string::npos) << text;

  // Insert the results of the calibration into the rig file.
  std::string file = test::text_of(SOFTGRIP_SOURCE_DIR "/config/rig.yaml");
  for (const std::string key : {"sensor", "valve"}) {
    const auto line_at = [&](const std::string& in, std::size_t from) { return in.find(key + ": {", from); };
    const std::size_t old_at = line_at(file, file.find("channels:"));
    const std::size_t new_at = line_at(text, 0);
    ASSERT_NE(new_at, std::string::npos) << key;
    file.replace(old_at, file.find('\n', old_at) - old_at,
                 text.substr(new_at, text.find('\n', new_at) - new_at));
  }
  document::Problems problems;
  const auto document = document::parse(SOFTGRIP_SOURCE_DIR "/config/rig.yaml", file, problems);
  const auto rig = rig::read_rig(document, problems);
  ASSERT_TRUE(rig) << problems.format() << text;
  EXPECT_NEAR(rig->wiring[0].displacement.scaling.y_at(5), results.sensor->points.y_at(5), 1e-3);
}

TEST_F(CalibrateTest, WarnsIfLessThanAFifthOfTheValveRangeIsUsed) {
  rig_.valves[0].range_max_kpa = 500;
  EXPECT_NEAR(share_of_valve(rig_, 0), 0.12, 1e-12);
  EXPECT_NE(snippet(rig_, {"2026-11-20", 0, {}, {}, {}, {}}).find("less than 1/5"), std::string::npos);
}

/// The valve gives 2.5 times the commanded pressure. The operator types this pressure at the first position.
TEST_F(CalibrateTest, AManometerReadingAboveTheCommandPreventsTheSecondPosition) {
  make();
  WatchedBoard board(*board_);
  MotionSession session(rig_, board, time_.clock, time_.stop());
  ASSERT_TRUE(session.connect());
  KnowingOperator person([] { return "25"; });
  const auto result = calibrate_valve(rig_, session, person, settings_, false);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ExitCode::not_acceptable);
  EXPECT_NE(result.error().text.find("a command of 40 kPa would give about 96 kPa"), std::string::npos)
      << result.error().text;
  EXPECT_EQ(person.asked.size(), 1U);
  EXPECT_LE(board.highest_kpa, settings_.low_kpa);
}

TEST_F(CalibrateTest, APressedEmergencyStopPreventsTheCalibration) {
  rig_.gpio.emplace();
  rig_.gpio->lines.resize(1);
  make();
  KnowingOperator person([] { return "10"; });
  const auto result = calibrate_sensor(rig_, *session_, person, settings_);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ExitCode::not_acceptable);
  EXPECT_NE(result.error().text.find("the emergency stop cannot be read"), std::string::npos);
}

}  // namespace
}  // namespace softgrip::tools::calibrate::calibrate_test
