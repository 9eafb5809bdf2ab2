// Tests softgrip doctor with healthy rigs and with faulty rigs. The rigs are simulated in virtual time.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "base/files.h"
#include "rig/rig_file.h"
#include "simulation/plant/simulated_board.h"
#include "tests/daemon/rig_under_test.h"
#include "tests/daemon/scripted_lines.h"
#include "tests/support/files.h"
#include "tests/tools/passing_board.h"
#include "tests/tools/virtual_time.h"
#include "tools/commissioning/examinations.h"
#include "tools/commissioning/motion.h"

namespace softgrip::tools::doctor::doctor_test {
namespace {

using simulation::LineFault;
using simulation::SensorFault;
using Event = simulation::SimulatedEvent;

/// A board that forwards all exchanges to another board. The left pressure monitor gives no readings.
class BlindMonitor final : public tools::testing::PassingBoard {
 public:
  using PassingBoard::PassingBoard;
  [[nodiscard]] drivers::BusStatus exchange(std::span<const double> commands_kpa,
                                            std::span<model::Reading> readings,
                                            std::chrono::nanoseconds deadline) noexcept override {
    const drivers::BusStatus status = PassingBoard::exchange(commands_kpa, readings, deadline);
    readings[0].pressure_kpa = std::numeric_limits<double>::quiet_NaN();
    return status;
  }
};

/// A board that forwards all exchanges to another board and records the highest command of each channel.
class NotingBoard final : public tools::testing::PassingBoard {
 public:
  using PassingBoard::PassingBoard;
  [[nodiscard]] drivers::BusStatus exchange(std::span<const double> commands_kpa,
                                            std::span<model::Reading> readings,
                                            std::chrono::nanoseconds deadline) noexcept override {
    for (std::size_t i = 0; i < commands_kpa.size(); ++i)
      highest_kpa[i] = std::max(highest_kpa[i], commands_kpa[i]);
    return PassingBoard::exchange(commands_kpa, readings, deadline);
  }

  std::array<double, 2> highest_kpa{};
};

/// A board that has a watchdog and reports the number of its Modbus clients.
class SharedBoard final : public tools::testing::PassingBoard {
 public:
  using PassingBoard::PassingBoard;
  [[nodiscard]] bool fed_by_readers() const noexcept override { return readers_feed; }
  [[nodiscard]] unsigned clients() const noexcept override { return counted; }

  bool readers_feed = true;
  unsigned counted = 0;
};

class DoctorTest : public ::testing::Test {
 protected:
  DoctorTest() {
    // Remove the stone, so that the small test motion of a finger causes no contact.
    for (simulation::SimulatedChannel& channel : simulated().channels) channel.plant.object.reset();
  }
  simulation::SimulatedBoardSettings& simulated() {
    return std::get<simulation::SimulatedBoardSettings>(rig_.board);
  }
  void at_once(Event event) { simulated().events.push_back(event); }
  void line_fault(LineFault::Kind kind, double share = 0) {
    Event event;
    event.kind = Event::Kind::line_fault;
    event.line = {kind, share};
    at_once(event);
  }
  void sensor_fault(SensorFault::Kind kind, std::size_t channel = Event::every_channel, double at_s = 0) {
    Event event;
    event.kind = Event::Kind::sensor_fault;
    event.channel = channel;
    event.sensor.kind = kind;
    event.at_s = at_s;
    at_once(event);
  }
  simulation::SimulatedBoard& make_board() {
    board_ = std::make_unique<simulation::SimulatedBoard>(simulated(), time_.clock);
    return *board_;
  }
  void move_on(drivers::Board& board) {
    examine_rig(rig_, board, time_.clock, time_.stop(), true, {}, findings_);
  }
  const Findings& examine(bool move) {
    make_board();
    examine_description(rig_, *board_, findings_);
    examine_rig(rig_, *board_, time_.clock, time_.stop(), move, {}, findings_);
    return findings_;
  }
  [[nodiscard]] Finding finding(const std::string& name) const {
    for (const Finding& finding : findings_.list()) {
      if (finding.name == name) return finding;
    }
    return {"no " + name, Verdict::ok, "", ""};
  }
  void expect(const std::string& name, Verdict verdict, const std::string& text) {
    const Finding found = finding(name);
    EXPECT_EQ(found.name, name);
    EXPECT_EQ(found.verdict, verdict) << found.text;
    EXPECT_NE(found.text.find(text), std::string::npos) << found.text;
    if (verdict != Verdict::ok) {
      EXPECT_FALSE(found.advice.empty()) << name << " does not say what to do";
    }
  }
  void expect_not_judged(const std::string& name, const std::string& because) {
    const Finding found = finding(name);
    EXPECT_EQ(found.verdict, Verdict::not_judged) << name << ": " << found.text;
    EXPECT_EQ(found.text, "not judged: " + because);
  }
  [[nodiscard]] double output_kpa(std::size_t channel) { return board_->plant(channel).held_command_kpa(); }

  rig::RigFile rig_ = daemon::testing::example_rig("rig.yaml");
  tools::testing::VirtualTime time_;
  std::unique_ptr<simulation::SimulatedBoard> board_;
  Findings findings_;
};

TEST_F(DoctorTest, AHealthyRigPassesAllChecks) {
  examine(true);
  EXPECT_EQ(findings_.worst(), Verdict::ok) << text_of({"", "", false, true}, findings_, 100, false);
  expect("board", Verdict::ok, "responds");
  expect("sensor left", Verdict::ok, "mm");
  expect("valve right", Verdict::ok, "kPa measured");
  expect("finger right", Verdict::ok, "moved");
  expect("model left", Verdict::ok, "RMS");
  expect("safe state", Verdict::ok, "confirmed");
  EXPECT_EQ(output_kpa(0), 0);
  EXPECT_EQ(output_kpa(1), 0);
}

TEST_F(DoctorTest, DoesNotMoveTheFingersWithoutTheMoveOption) {
  double highest = 0;
  examine(false);
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}})
    highest = std::max(highest, board_->plant(i).pressure_kpa());
  EXPECT_EQ(highest, 0);
  EXPECT_EQ(finding("valve left").name, "no valve left");
  EXPECT_EQ(findings_.worst(), Verdict::ok);
}

TEST_F(DoctorTest, AnUnreachableBoardIsTheOnlyFailure) {
  Event lost;
  lost.kind = Event::Kind::bus_lost;
  board_ = std::make_unique<simulation::SimulatedBoard>(simulated(), time_.clock);
  board_->happen(lost);
  examine_rig(rig_, *board_, time_.clock, time_.stop(), true, {}, findings_);
  expect("board", Verdict::fail, "the simulated bus is down");
  EXPECT_EQ(findings_.count(Verdict::fail), 1U);
  expect_not_judged("sensor left", "the board does not respond");
  expect_not_judged("sensor right", "the board does not respond");
}

TEST_F(DoctorTest, ABoardLostDuringTheMotionFailsMotionAndSafeState) {
  Event silent;
  silent.kind = Event::Kind::bus_lost;
  silent.status = drivers::BusStatus::timed_out;
  silent.at_s = 2;
  at_once(silent);
  examine(true);
  expect("motion left", Verdict::fail, "simulated");
  expect_not_judged("motion right", "see `motion left`");
  expect("safe state", Verdict::fail, "did not confirm");
}

/// The ramp to the rest pressures and the wait for their confirmation take several seconds after the loss.
TEST_F(DoctorTest, ABoardLostDuringTheMotionIsReportedBeforeTheEnd) {
  for (control::ChannelSettings& channel : rig_.settings.channels) channel.limits.slew_down_kpa_per_s = 5;
  simulated().watchdog_timeout_s = 0;
  Event lost;
  lost.kind = Event::Kind::bus_lost;
  lost.status = drivers::BusStatus::timed_out;
  lost.at_s = 1.8;  // the pressure rises
  at_once(lost);
  const Nanoseconds lost_at = time_.clock.now() + nanoseconds(lost.at_s);
  make_board();
  std::vector<std::string> reasons;
  Nanoseconds told_at = 0;
  examine_rig(rig_, *board_, time_.clock, time_.stop(), true, {}, findings_, nullptr,
              [&](const std::string& why) {
                reasons.push_back(why);
                told_at = time_.clock.now();
              });
  expect("motion left", Verdict::fail, "simulated");
  expect("safe state", Verdict::fail, "did not confirm");
  ASSERT_EQ(reasons.size(), 1U);
  EXPECT_NE(reasons[0].find("simulated"), std::string::npos) << reasons[0];
  EXPECT_LT(seconds(told_at - lost_at), 0.1);
  EXPECT_GT(seconds(time_.clock.now() - told_at), 3);
}

TEST_F(DoctorTest, ABoardThatRespondsIsNotReportedAsSilent) {
  make_board();
  examine_rig(rig_, *board_, time_.clock, time_.stop(), true, {}, findings_, nullptr,
              [](const std::string& why) { ADD_FAILURE() << why; });
  expect("safe state", Verdict::ok, "confirmed");
}

TEST_F(DoctorTest, WarnsOfAMissingWatchdog) {
  rig_.settings.safety.board_vents_when_silent = false;
  rig_.accept_no_watchdog = rig::no_watchdog_words;
  examine(true);
  expect("watchdog", Verdict::warn, "the outputs keep their last pressure");
}

/// A request of any client resets the watchdog of this board. Some boards with this property report the
/// number of their clients.
TEST_F(DoctorTest, AWatchdogThatReadersFeedAndASecondClientCauseWarnings) {
  rig_.settings.safety.board_vents_when_silent = true;
  board_ = std::make_unique<simulation::SimulatedBoard>(simulated(), time_.clock);
  SharedBoard board(*board_);
  const auto again = [&](bool readers_feed, unsigned counted) {
    findings_ = {};
    board.readers_feed = readers_feed;
    board.counted = counted;
    examine_description(rig_, board, findings_);
    examine_rig(rig_, board, time_.clock, time_.stop(), false, {}, findings_);
  };
  again(true, 0);
  expect("watchdog", Verdict::warn, "even a client that only reads resets the watchdog");
  EXPECT_EQ(finding("clients").name, "no clients");
  again(true, 1);
  expect("clients", Verdict::ok, "number of clients at the board: 1");
  again(true, 2);
  expect("clients", Verdict::warn, "the board has 2 clients");
  again(false, 2);
  expect("watchdog", Verdict::ok, "vents if communication stops");
  expect("clients", Verdict::ok, "number of clients at the board: 2");
}

TEST_F(DoctorTest, APressedEmergencyStopPreventsTheMotionButNotTheReadings) {
  rig_.gpio.emplace();
  rig_.gpio->lines.resize(1);
  daemon::testing::Terminals terminals;
  const auto lines = terminals.lines();
  terminals.set(drivers::GpioRole::emergency_stop, true);
  make_board();
  NotingBoard board(*board_);
  examine_rig(rig_, board, time_.clock, time_.stop(), true, {}, findings_, lines.get());
  expect("sensor left", Verdict::ok, "mm");
  expect("motion left", Verdict::fail, "the emergency stop is pressed");
  expect_not_judged("motion right", "see `motion left`");
  EXPECT_EQ(board.highest_kpa[0], 0);
  EXPECT_EQ(board.highest_kpa[1], 0);
}

TEST_F(DoctorTest, WithoutAWatchdogAStaticCheckDoesNotAccessTheBoard) {
  rig_.settings.safety.board_vents_when_silent = false;
  examine(false);
  expect("sensors", Verdict::warn, "the fingers may still hold a part");
  EXPECT_TRUE(time_.clock.now() < 2'000'000'000) << "softgrip doctor must not exchange data with the board";
}

TEST_F(DoctorTest, ASensorThatIsOutOfRangeFails) {
  sensor_fault(SensorFault::Kind::out_of_range);
  examine(false);
  expect("sensor left", Verdict::fail, "out_of_range");
}

/// A finger without valid displacement readings could exceed its limits unnoticed. softgrip doctor must
/// therefore not move this finger. It may move all other fingers.
TEST_F(DoctorTest, ASensorThatIsOutOfRangePreventsTheMotionOfTheFinger) {
  sensor_fault(SensorFault::Kind::out_of_range, 0);
  NotingBoard board(make_board());
  move_on(board);
  expect("sensor left", Verdict::fail, "out_of_range");
  expect_not_judged("motion left", "see `sensor left`");
  EXPECT_EQ(finding("valve left").name, "no valve left");
  EXPECT_EQ(finding("finger left").name, "no finger left");
  EXPECT_EQ(board.highest_kpa[0], 0);
  expect("finger right", Verdict::ok, "moved");
  EXPECT_GT(board.highest_kpa[1], 10);
  EXPECT_EQ(findings_.count(Verdict::fail), 1U) << text_of({"", "", false, true}, findings_, 100, false);
}

TEST_F(DoctorTest, ASensorThatIsLostDuringTheMotionEndsTheMotion) {
  // The fault begins during the rise of the pressure, from 1 s to 2 s.
  sensor_fault(SensorFault::Kind::out_of_range, 0, 1.5);
  NotingBoard board(make_board());
  move_on(board);
  expect("motion left", Verdict::fail, "are not valid (out_of_range)");
  expect_not_judged("motion right", "see `motion left`");
  EXPECT_GT(board.highest_kpa[0], 0);
  EXPECT_LT(board.highest_kpa[0], 10);
  EXPECT_EQ(board.highest_kpa[1], 0);
  EXPECT_EQ(output_kpa(0), 0);
}

TEST_F(DoctorTest, AChannelWithoutASensorAndAPressureReadingIsNotMoved) {
  rig_.settings.channels[0].displacement_used = false;
  BlindMonitor blind(make_board());
  NotingBoard board(blind);
  move_on(board);
  expect_not_judged("motion left", "see `pressure left`");
  EXPECT_EQ(board.highest_kpa[0], 0);
  expect("finger right", Verdict::ok, "moved");
}

TEST_F(DoctorTest, AFailedMonitorDoesNotPreventTheCheckOfTheFinger) {
  BlindMonitor board(make_board());
  move_on(board);
  expect("pressure left", Verdict::fail, "no reading");
  expect_not_judged("valve left", "see `pressure left`");
  expect("finger left", Verdict::ok, "moved");
  EXPECT_EQ(findings_.count(Verdict::fail), 1U);
}

TEST_F(DoctorTest, ASensorThatIsStuckFailsOnlyWhenTheFingerMoves) {
  sensor_fault(SensorFault::Kind::stuck);
  examine(false);
  expect("sensor left", Verdict::warn, "no variation");
  findings_ = {};
  examine(true);
  expect("valve left", Verdict::ok, "kPa measured");
  expect("finger left", Verdict::fail, "moved 0.00 mm");
  EXPECT_NE(finding("finger left").advice.find("the pressure is present"), std::string::npos);
}

TEST_F(DoctorTest, ABlockedAirLineFailsTheValveCheck) {
  line_fault(LineFault::Kind::blocked);
  examine(true);
  expect("valve left", Verdict::fail, "15.00 kPa commanded");
  expect_not_judged("finger left", "see `valve left`");
  expect_not_judged("model left", "see `valve left`");
  EXPECT_EQ(findings_.count(Verdict::fail), 2U)
      << "both fingers must fail, because the simulated fault blocks all air lines";
  EXPECT_EQ(output_kpa(0), 0);
}

TEST_F(DoctorTest, ALeakingAirLineFailsTheValveCheck) {
  line_fault(LineFault::Kind::leaking, 0.4);
  examine(true);
  expect("valve left", Verdict::fail, "commanded, 9");
}

TEST_F(DoctorTest, ARefusedWriteFailsTheMotion) {
  Event refused;
  refused.kind = Event::Kind::write_refused;
  refused.at_s = 1.5;
  at_once(refused);
  examine(true);
  expect("motion left", Verdict::fail, "the output did not change to the written command");
}

TEST_F(DoctorTest, AModelOfASofterFingerIsUnfit) {
  rig_.settings.channels[0].health.unfit_mm = 0.3;
  rig_.settings.channels[0].health.model_error_mm = 0.05;
  rig_.settings.channels[0].health.noise_mm = 0.03;
  for (simulation::SimulatedChannel& channel : simulated().channels) {
    channel.plant.object = simulation::PlantObject{1, 0.5};  // beyond 1 mm, the finger moves half as far, as
                                                             // if it were twice as stiff
  }
  examine(true);
  expect("model left", Verdict::fail, "unfit above 0.30");
}

TEST_F(DoctorTest, AnInvertedSensorFailsTheFingerCheck) {
  ChannelSample rest;
  rest.displacement_mm.deviation = 0.03;
  Motion motion;
  motion.command_kpa = 15;
  motion.model_mm = 5;
  motion.up.resize(2);
  motion.up[0].displacement_mm.mean = -5;
  judge_motion(rig_, 0, rest, motion, {}, findings_);
  expect("finger left", Verdict::fail, "moved -5.00 mm");
  EXPECT_NE(finding("finger left").advice.find("direction opposite to the prediction"), std::string::npos);
}

TEST_F(DoctorTest, BusAdviceDependsOnTheKindOfBusFault) {
  EXPECT_NE(bus_advice("closed_at_once").find("no further client"), std::string_view::npos);
  EXPECT_NE(bus_advice("exception").find("board map"), std::string_view::npos);
  EXPECT_NE(bus_advice("timed_out").find("settle_s"), std::string_view::npos);
  EXPECT_EQ(bus_advice("disconnected"), bus_advice("a kind of fault that this version does not know"));
  EXPECT_FALSE(wants_bus_examination(findings_));
  findings_.warn("board", "", "");
  EXPECT_FALSE(wants_bus_examination(findings_));
  findings_.fail("sensor left", "", "");
  EXPECT_TRUE(wants_bus_examination(findings_));
}

TEST_F(DoctorTest, ARateAboveTheBusBudgetFailsUnlessAccepted) {
  class SlowBoard final : public drivers::Board {
   public:
    [[nodiscard]] std::size_t channels() const noexcept override { return 2; }
    [[nodiscard]] drivers::BusStatus connect(std::chrono::nanoseconds) noexcept override {
      return drivers::BusStatus::disconnected;
    }
    [[nodiscard]] drivers::BusStatus exchange(std::span<const double>, std::span<model::Reading>,
                                              std::chrono::nanoseconds) noexcept override {
      return drivers::BusStatus::disconnected;
    }
    [[nodiscard]] std::string describe() const override { return "a slow board"; }
    [[nodiscard]] Budget budget() const override { return {0.0469, "9600 8N1: 46.9 ms"}; }
    [[nodiscard]] bool has_watchdog() const noexcept override { return true; }
    [[nodiscard]] std::chrono::nanoseconds watchdog_time() const noexcept override {
      return std::chrono::seconds(1);
    }
  };
  examine_description(rig_, SlowBoard(), findings_);
  expect("bus budget", Verdict::fail, "46.9 ms; a cycle is 5 ms");
  EXPECT_NE(finding("bus budget").advice.find("lower rate_hz to 19"), std::string::npos);
  findings_ = {};
  rig_.accept_over_budget = true;
  examine_description(rig_, SlowBoard(), findings_);
  expect("bus budget", Verdict::warn, "46.9 ms");
}

TEST_F(DoctorTest, AStopByTheUserVentsTheOutputs) {
  time_.stop_at = 2'500'000'000;  // stop while the pressure rises
  examine(true);
  expect("motion left", Verdict::fail, "stopped by the user");
  EXPECT_EQ(output_kpa(0), 0);
  expect("safe state", Verdict::ok, "confirmed");
}

TEST_F(DoctorTest, FailsIfTheRecordingFolderIsNotWritable) {
  const ScratchFolder folder;
  rig_.recorder.mode = rig::RecorderSettings::Mode::always;
  rig_.recorder.directory = folder.path() + "/new/runs";
  examine_disk(rig_, findings_);
  EXPECT_EQ(finding("disk").name, "disk");
  EXPECT_NE(finding("disk").text.find("GB free"), std::string::npos) << finding("disk").text;
  EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "no file remains";
  findings_ = {};
  rig_.recorder.directory = "/proc/softgrip-runs";
  examine_disk(rig_, findings_);
  expect("disk", Verdict::fail, "cannot be written");
  findings_ = {};
  rig_.recorder.directory = "/dev/null";
  examine_disk(rig_, findings_);
  expect("disk", Verdict::fail, "no folder");
}

/// Returns the status that a daemon without faults and warnings reports.
nlohmann::ordered_json healthy_status() {
  return nlohmann::ordered_json::parse(R"({"version": "1", "rig": "bench", "rate_hz": 200, "state": "idle",
    "fault": null, "sequence": null, "bus": {"board": "ADAM", "connected": true},
    "channels": [{"name": "left", "validity": "valid", "displacement_mm": 0.1, "command_kpa": 0, "health": "healthy",
                  "health_rms_mm": 0.1}],
    "recording": {"dropped_rows": 0, "error": null}, "gpio": null,
    "real_time": {"degraded": false, "steps": [{"name": "kernel", "outcome": "verified", "detail": "6.1, PREEMPT_RT"}]}})");
}
nlohmann::ordered_json healthy_statistics() {
  return nlohmann::ordered_json::parse(
      R"({"loop": {"ticks": 10000, "slips_woken_late": 0, "slips_took_long": 0,
    "wake_up": {"p99_us": 40, "max_us": 90}}, "bus": {"exchanges": 10000, "failures": 0, "exchange": {"p99_us": 900}}})");
}
Verdict worst_after(const std::function<void(nlohmann::ordered_json&, nlohmann::ordered_json&)>& spoil) {
  auto status = healthy_status();
  auto statistics = healthy_statistics();
  spoil(status, statistics);
  Findings findings;
  examine_daemon(status, statistics, "bench", findings);
  return findings.worst();
}

TEST(ExamineDaemon, DerivesTheVerdictFromStatusAndStatistics) {
  using Json = nlohmann::ordered_json;
  EXPECT_EQ(worst_after([](Json&, Json&) {}), Verdict::ok);
  EXPECT_EQ(worst_after([](Json& status, Json&) { status["rig"] = "another"; }), Verdict::warn);
  EXPECT_EQ(worst_after([](Json& status, Json&) {
              status["fault"] = {{"code", "F101"}, {"name", "bus_down"}};
            }),
            Verdict::fail);
  EXPECT_EQ(worst_after([](Json& status, Json&) { status["bus"]["connected"] = false; }), Verdict::fail);
  EXPECT_EQ(worst_after([](Json& status, Json&) { status["channels"][0]["validity"] = "frozen"; }),
            Verdict::fail);
  EXPECT_EQ(worst_after([](Json& status, Json&) { status["recording"]["error"] = "disk full"; }),
            Verdict::fail);
  EXPECT_EQ(worst_after([](Json&, Json& statistics) { statistics["loop"]["slips_took_long"] = 3; }),
            Verdict::warn);
  EXPECT_EQ(worst_after([](Json&, Json& statistics) { statistics["loop"]["slips_took_long"] = 300; }),
            Verdict::fail);
  EXPECT_EQ(worst_after([](Json& status, Json&) { status["gpio"] = {{"lost", true}}; }), Verdict::fail);
  EXPECT_EQ(worst_after([](Json& status, Json&) {
              status["gpio"] = {{"emergency_stop", true}};
            }),
            Verdict::warn);
}

TEST(ExamineDaemon, MissedCyclesReferToAFindingOfTheDoctor) {
  auto statistics = healthy_statistics();
  for (const int overruns : {3, 300}) {
    statistics["loop"]["slips_took_long"] = overruns;
    auto status = healthy_status();
    status["real_time"]["steps"].push_back(
        {{"name", "scheduling of the loop"}, {"outcome", "verified"}, {"detail", "SCHED_FIFO 70"}});
    Findings findings;
    examine_daemon(status, statistics, "bench", findings);
    const auto loop = std::ranges::find(findings.list(), "loop", &Finding::name);
    ASSERT_NE(loop, findings.list().end());
    const std::size_t begin = loop->advice.find('`');
    ASSERT_NE(begin, std::string::npos) << loop->advice;
    const std::string name = loop->advice.substr(begin + 1, loop->advice.find('`', begin + 1) - begin - 1);
    EXPECT_NE(std::ranges::find(findings.list(), name, &Finding::name), findings.list().end()) << name;
  }
}

/// Returns the finding with this name that a daemon with the given channel causes; an empty finding if there
/// is no such finding.
Finding finding_of(const std::string& name, const nlohmann::ordered_json& channel,
                   const std::string& state = "idle") {
  auto status = healthy_status();
  status["state"] = state;
  status["channels"][0].update(channel);
  Findings findings;
  examine_daemon(status, healthy_statistics(), "bench", findings);
  for (const Finding& finding : findings.list()) {
    if (finding.name == name) return finding;
  }
  return {};
}

TEST(ExamineDaemon, AnUnusedSensorIsJudgedAsWithoutADaemon) {
  const nlohmann::ordered_json unused{{"displacement_used", false}, {"validity", "out_of_range"}};
  EXPECT_EQ(finding_of("sensor left", unused).verdict, Verdict::ok);
  EXPECT_EQ(finding_of("sensor left", unused).text, "not used (displacement_used: false)");
  EXPECT_EQ(finding_of("model left", unused).name, "");
  const nlohmann::ordered_json used{{"displacement_used", true}, {"validity", "out_of_range"}};
  EXPECT_EQ(finding_of("sensor left", used).verdict, Verdict::fail);
}

TEST(ExamineDaemon, ThePressureMonitorIsJudgedAsWithoutADaemon) {
  const auto monitor = [](const nlohmann::ordered_json& pressure_kpa) {
    return nlohmann::ordered_json{{"pressure_measured", true},
                                  {"pressure_kpa", pressure_kpa},
                                  {"command_kpa", 20},
                                  {"limits", {{"pressure_min_kpa", 0}, {"pressure_max_kpa", 60}}}};
  };
  const Finding broken = finding_of("pressure left", monitor(nullptr));
  EXPECT_EQ(broken.verdict, Verdict::fail);
  EXPECT_EQ(broken.text, "no reading of the pressure monitor is valid");
  EXPECT_EQ(finding_of("pressure left", monitor(nullptr), "running").verdict, Verdict::fail);
  EXPECT_EQ(finding_of("pressure left", monitor(22)).verdict, Verdict::ok);
  EXPECT_EQ(finding_of("pressure left", monitor(22)).text, "22.00 kPa at rest");
  EXPECT_EQ(finding_of("pressure left", monitor(24)).verdict, Verdict::warn);
  EXPECT_EQ(finding_of("pressure left", monitor(24), "running").verdict, Verdict::ok)
      << "the pressure may follow the command with a delay";
  EXPECT_EQ(finding_of("pressure left", {{"pressure_measured", false}, {"pressure_kpa", nullptr}}).name, "");
}

TEST(ExamineDaemon, AFaultOfThePressureMonitorIsOneFailure) {
  auto status = healthy_status();
  status["channels"][0].update({{"pressure_measured", true}, {"pressure_kpa", nullptr}});
  status["fault"] = {{"code", "F208"},
                     {"name", "pressure_invalid"},
                     {"channel", "left"},
                     {"present", {{"code", "F208"}, {"name", "pressure_invalid"}, {"channel", "left"}}}};
  Findings findings;
  examine_daemon(status, healthy_statistics(), "bench", findings);
  EXPECT_EQ(findings.count(Verdict::fail), 1U);
  const std::string text = text_of({"bench", "rig.yaml", true}, findings, 200, false);
  EXPECT_NE(text.find("F208 pressure_invalid of left is latched, see `pressure left`"), std::string::npos)
      << text;
}

TEST(ExamineDaemon, AnUnfitModelFailsOnlyAfterASequenceHasRun) {
  using Json = nlohmann::ordered_json;
  const auto unfit = [](Json& status, Json&) { status["channels"][0]["health"] = "unfit"; };
  EXPECT_EQ(worst_after(unfit), Verdict::warn)
      << "at start-up, the motion of the finger to rest can make the model unfit";
  EXPECT_EQ(worst_after([&](Json& status, Json& statistics) {
              unfit(status, statistics);
              status["sequence"] = {{"name", "pick"}};
            }),
            Verdict::fail);
}

TEST(ExamineDaemon, ASettingThatTheRigFileDoesNotRequestIsNamed) {
  auto status = healthy_status();
  auto& step = status["real_time"]["steps"][0];
  step = {{"name", "processors"}, {"detail", ""}};
  step["outcome"] = "not asked for";  // words-ok: documented value
  Findings findings;
  examine_daemon(status, healthy_statistics(), "bench", findings);
  const std::string text = text_of({"bench", "rig.yaml", true}, findings, 200, false);
  EXPECT_NE(text.find("not requested in the rig file"), std::string::npos) << text;
}

TEST(ExamineDaemon, AnEmptyReplyIsAFailure) {
  Findings findings;
  examine_daemon({}, {}, "bench", findings);
  EXPECT_EQ(findings.worst(), Verdict::fail);
}

TEST(ExamineDaemon, ALostConnectionToTheBoardIsOneFailure) {
  auto status = healthy_status();
  status["bus"] = {{"board", "ADAM"}, {"connected", false}, {"attempts", 7}, {"retry_s", 2}};
  status["channels"][0]["validity"] = "stale";
  status["fault"] = {{"code", "F101"},
                     {"name", "bus_down"},
                     {"channel", nullptr},
                     {"present", {{"code", "F101"}, {"name", "bus_down"}, {"channel", nullptr}}}};
  Findings findings;
  examine_daemon(status, healthy_statistics(), "bench", findings);
  EXPECT_EQ(findings.count(Verdict::fail), 1U);
  const std::string text = text_of({"bench", "rig.yaml", true}, findings, 200, false);
  EXPECT_NE(text.find("FAIL board"), std::string::npos) << text;
  EXPECT_NE(text.find("not connected after 7 attempts, one every 2 s"), std::string::npos) << text;
  EXPECT_NE(text.find("F101 bus_down is latched, see `board`"), std::string::npos) << text;
}

TEST(ExamineDaemon, ASensorFaultIsOneFailureWhetherItsCauseIsPresentOrNot) {
  auto status = healthy_status();
  status["channels"][0]["validity"] = "out_of_range";
  status["fault"] = {{"code", "F202"},
                     {"name", "reading_out_of_range"},
                     {"channel", "left"},
                     {"present", {{"code", "F202"}, {"name", "reading_out_of_range"}, {"channel", "left"}}}};
  Findings findings;
  examine_daemon(status, healthy_statistics(), "bench", findings);
  EXPECT_EQ(findings.count(Verdict::fail), 1U);
  EXPECT_EQ(findings.count(Verdict::not_judged), 2U) << "the fault and the model must not be judged";
  status["channels"][0]["validity"] = "valid";
  status["fault"]["present"] = nullptr;
  status["fault"]["next"] = "The cause is gone.";
  findings = {};
  examine_daemon(status, healthy_statistics(), "bench", findings);
  EXPECT_EQ(findings.count(Verdict::fail), 1U);
  const std::string text = text_of({"bench", "rig.yaml", true}, findings, 200, false);
  EXPECT_NE(text.find("F202 reading_out_of_range of left: "), std::string::npos) << text;
  EXPECT_NE(text.find("The cause is gone."), std::string::npos) << text;
}

TEST(Findings, TheVerdictStatesThatTheRigIsSimulated) {
  Findings findings;
  findings.ok("board", "answers");
  const Examination simulated{"x", "rig.yaml", false, false, true};
  EXPECT_EQ(text_of(simulated, findings, 100, false),
            "rig x (rig.yaml), SIMULATED: softgripd not running; checked without motion\n"
            " ok   board  answers\n"
            "fit to run. SIMULATED: no board, valve, finger or sensor was examined\n");
  EXPECT_TRUE(result::json_of(fields_of(simulated, findings))["simulated"]);
}

TEST(Findings, TheTextShowsTheAdviceBelowEachFailure) {
  Findings findings;
  findings.ok("kernel", "6.1, PREEMPT_RT");
  findings.fail("board", "does not answer", "check power and cable");
  EXPECT_EQ(text_of({"bench", "rig.yaml", false, false}, findings, 80, false),
            "rig bench (rig.yaml): softgripd not running; checked without motion\n"
            " ok   kernel  6.1, PREEMPT_RT\n"
            " FAIL board   does not answer\n"
            "              -> check power and cable\n"
            "NOT FIT: 1 failure\n");
}

}  // namespace
}  // namespace softgrip::tools::doctor::doctor_test
