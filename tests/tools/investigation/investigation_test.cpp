// Tests the steps of `softgrip investigate` for a finger with stress softening. The first log of this finger
// does not suffice to distinguish the possible causes.

#include "tools/investigation/investigation.h"
#include "base/files.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "model/file/model_file.h"
#include "simulation/plant/simulated_board.h"
#include "sysid/diagnosis/experiments/waveform.h"
#include "sysid/logs/simulated_log.h"
#include "tools/investigation/experiment_rig.h"

namespace softgrip::tools::investigation_test {
namespace {

namespace fs = std::filesystem;

constexpr double interval_s = 0.04;

model::Model loaded(const std::string& name) {
  document::Problems problems;
  return model::load_model(SOFTGRIP_SOURCE_DIR "/config/models/" + name + ".yaml", problems).value();
}

/// Returns the model of the true finger. Its stress softening is not a part of the model that the command
/// receives.
model::Model finger() {
  return model::with_block(loaded("bench_twin"),
                           {sysid::find_cause("stress_softening")->forms.front().type, {0.006, 0}});
}

/// A command with two loads. The second load is larger than the first one, and no load is repeated.
const sysid::Waveform first_load{
    "first", "", {{0, 0}, {1, 0}, {4, 30}, {7, 0}, {9, 0}, {13, 55}, {17, 0}, {20, 0}}};

/// Returns the response of the finger to the waveform. If `after_first` is true, the first load and a long
/// rest precede the waveform. The finger is then still softened by the first load.
sysid::Log played(const sysid::Waveform& waveform, bool after_first, std::uint64_t seed) {
  sysid::Log log;
  log.name = log.path = waveform.name;
  if (after_first) {
    log.pressure_command_kpa = sysid::sampled_kpa(first_load, interval_s);
    log.pressure_command_kpa.resize(log.pressure_command_kpa.size() + 3000, 0.0);
  }
  const std::size_t before = log.pressure_command_kpa.size();
  for (const double p : sysid::sampled_kpa(waveform, interval_s)) log.pressure_command_kpa.push_back(p);
  for (std::size_t i = 0; i < log.pressure_command_kpa.size(); ++i)
    log.time_s.push_back(static_cast<double>(i) * interval_s);
  simulate(finger(), {0.04, seed}, log);
  return sysid::slice(log, before, log.size());
}

class InvestigationTest : public ::testing::Test {
 protected:
  void SetUp() override {
    options_.given = loaded("bench_twin");
    options_.logs = {played(first_load, false, 1)};
    options_.experiment.limits = sysid::RigLimits{58, 300};
    options_.out = folder_.string();
    options_.play = [this](const sysid::NextExperiment& experiment,
                           const std::string& folder) -> tl::expected<sysid::Log, NotPlayed> {
      EXPECT_TRUE(fs::exists(fs::path(folder) / "next_experiment.yaml"));
      ++plays_;
      return played(experiment.best->waveform, true, 2);
    };
  }

  const ScratchFolder scratch_;
  fs::path folder_ = scratch_.path();
  InvestigationOptions options_;
  int plays_ = 0;
};

TEST_F(InvestigationTest, FindsTheTrueCauseAndRecordsEveryStep) {
  const auto result = investigate(options_);
  ASSERT_TRUE(result) << result.error().why;
  EXPECT_EQ(result->end, InvestigationEnd::settled) << result->why;
  ASSERT_EQ(result->last.causes.size(), 1U);
  EXPECT_EQ(result->last.causes[0].cause.id, "stress_softening");
  EXPECT_EQ(result->logs.size(), 1 + static_cast<std::size_t>(plays_));
  double minutes = 0;
  for (const InvestigationStep& step : result->steps) {
    EXPECT_TRUE(fs::exists(folder_ / step.folder / "diagnosis.json"));
    minutes += step.minutes;
  }
  EXPECT_EQ(minutes, result->spent_minutes);
  EXPECT_LE(minutes, result->budget_minutes);
  const auto json = result::json_of(fields_of(*result, "a test"));
  EXPECT_EQ(json["end"], "settled");
  EXPECT_NE(investigation_html(*result, "a test", "").find("step_1"), std::string::npos);
  EXPECT_EQ(json["steps"].size(), result->steps.size());
}

TEST_F(InvestigationTest, MovesNothingWithoutBudget) {
  options_.budget_minutes = 0.1;
  const auto result = investigate(options_);
  ASSERT_TRUE(result) << result.error().why;
  EXPECT_EQ(plays_, 0);
  EXPECT_EQ(result->spent_minutes, 0);
  if (result->last.verdict == sysid::Verdict::ambiguous) {
    EXPECT_EQ(result->end, InvestigationEnd::budget_spent);
  }
}

sysid::NextExperiment small_experiment() {
  sysid::NextExperiment next;
  next.best =
      sysid::JudgedWaveform{{"small", "up and down", {{0, 0}, {1, 0}, {2, 30}, {3, 0}, {4, 0}}}, 0.2, {}, 1};
  next.separates = {"stress_softening", "slow_creep"};
  next.predicted_separation_sigma = 9;
  return next;
}

ExperimentRig simulated_rig() {
  document::Problems problems;
  auto rig = rig::load_rig(SOFTGRIP_SOURCE_DIR "/config/rig.yaml", problems);
  EXPECT_TRUE(rig) << problems.format();
  return experiment_rig(std::move(*rig), "left").value();
}

TEST(ExperimentRig, RunsOnASimulatedBoardWithoutConsentAndReturnsTheLog) {
  const ScratchFolder scratch;
  const fs::path folder = scratch.path();
  const Player play = rig_player(simulated_rig(), [](const std::string&) {
    ADD_FAILURE() << "an experiment on a simulated rig must not require consent";
    return false;
  });
  const auto log = play(small_experiment(), folder.string());
  ASSERT_TRUE(log) << log.error().why;
  EXPECT_NEAR(*std::max_element(log->pressure_command_kpa.begin(), log->pressure_command_kpa.end()), 30, 0.5);
  EXPECT_GT(sysid::span_mm(*log), 3);
}

TEST(ExperimentRig, AFaultThatEndsTheExperimentIsNamed) {
  const ScratchFolder scratch;
  const fs::path folder = scratch.path();
  ExperimentRig rig = simulated_rig();
  rig.rig.settings.channels[rig.channel].limits.displacement_max_mm = 3;
  rig.rig.settings.channels[rig.channel].limits.displacement_margin_mm = 1;
  const auto log = rig_player(rig, {})(small_experiment(), folder.string());
  ASSERT_FALSE(log);
  EXPECT_FALSE(log.error().stopped);
  EXPECT_NE(log.error().why.find("F206 displacement_beyond_limits"), std::string::npos) << log.error().why;
}

TEST(ExperimentRig, LimitsThePressureByChannelLogsAndDisplacementRange) {
  const ExperimentRig rig = simulated_rig();
  EXPECT_EQ(rig.limits(0, 0).pressure_max_kpa, 60);
  EXPECT_EQ(rig.limits(0, 0).slew_kpa_per_s, 300);
  EXPECT_EQ(rig.limits(0.5, 30).pressure_max_kpa, 0.85 * 35 / 0.5)
      << "above the highest pressure of the logs, a margin applies";
  EXPECT_EQ(rig.limits(0.7, 45).pressure_max_kpa, 45) << "the limit must be the highest pressure of the logs";
  EXPECT_EQ(rig.limits(1, 35).pressure_max_kpa, 0.95 * 35)
      << "a margin between the motion and the end of the sensor range must remain";
  document::Problems problems;
  auto file = rig::load_rig(SOFTGRIP_SOURCE_DIR "/config/rig.yaml", problems);
  EXPECT_FALSE(experiment_rig(*file, "")) << "the rig has two channels, so a channel must be selected";
  EXPECT_FALSE(experiment_rig(*file, "middle"));
}

TEST(CommandPlayer, RunsTheCommandAndReadsTheLog) {
  const ScratchFolder scratch;
  const fs::path folder = scratch.path() + "/command's folder";
  fs::create_directories(folder);
  const auto allow = [](const std::string&) { return true; };
  const std::string awk =
      R"(f() { awk -F, 'NR==1{print $0 ",displacement_mm"} NR>1{print $0 "," $2/3+sin(NR)/50}' "$1" > "$2"; }; f)";
  const auto log = command_player(awk, 0.02, allow)(small_experiment(), folder.string());
  ASSERT_TRUE(log) << log.error().why;
  EXPECT_EQ(log->size(), 201U);
  EXPECT_NEAR(log->time_s[1], 0.02, 1e-12);
  EXPECT_FALSE(command_player("false", 0.02, allow)(small_experiment(), folder.string()));
  bool called = false;
  const auto refused = command_player("touch called;", 0.02, [&](const std::string& what) {
    called = true;
    EXPECT_NE(what.find("30 kPa"), std::string::npos) << what;
    return false;
  })(small_experiment(), folder.string());
  EXPECT_TRUE(called);
  ASSERT_FALSE(refused);
  EXPECT_TRUE(refused.error().stopped);
}

/// Tests a finger whose stiffness increases with the displacement. No command can distinguish this finger
/// from a finger with a nonlinear sensor.
class GaugeStepTest : public InvestigationTest {
 protected:
  void SetUp() override {
    InvestigationTest::SetUp();
    const model::Model finger = model::with_block(
        loaded("bench_twin"), {sysid::find_cause("stiffening")->forms.front().type, {0.01}});
    options_.logs.clear();
    for (const double top_kpa : {30.0, 55.0}) {
      const sysid::Waveform load{"load", "", {{0, 0}, {1, 0}, {5, top_kpa}, {8, top_kpa}, {12, 0}, {20, 0}}};
      sysid::Log& log = options_.logs.emplace_back();
      log.name = log.path = "load";
      log.pressure_command_kpa = sysid::sampled_kpa(load, interval_s);
      for (std::size_t i = 0; i < log.pressure_command_kpa.size(); ++i)
        log.time_s.push_back(static_cast<double>(i) * interval_s);
      simulate(finger, {0.03, options_.logs.size()}, log);
    }
    options_.play = [this](const sysid::NextExperiment&,
                           const std::string&) -> tl::expected<sysid::Log, NotPlayed> {
      ++plays_;
      return tl::unexpected(
          NotPlayed{false, "no waveform in the list of experiments separates these causes"});
    };
    options_.take_gauge = [this](const std::vector<double>& positions_mm, const std::string& folder) {
      ++checks_;
      EXPECT_TRUE(fs::exists(fs::path(folder) / "gauge_positions.csv"));
      std::vector<sysid::GaugeReading> readings;
      for (const double p : positions_mm)
        readings.push_back({p, p + 0.01 * std::sin(7.0 * static_cast<double>(readings.size())), 200});
      return gauge_file_of(readings, folder);
    };
  }

  int checks_ = 0;
};

TEST_F(GaugeStepTest, ALinearSensorAttributesTheErrorToTheFingerAndIsNotCheckedAgain) {
  const auto result = investigate(options_);
  ASSERT_TRUE(result) << result.error().why;
  EXPECT_EQ(result->end, InvestigationEnd::settled) << result->why;
  ASSERT_EQ(result->last.causes.size(), 1U);
  EXPECT_EQ(result->last.causes[0].cause.id, "stiffening");
  EXPECT_EQ(plays_, 0);
  EXPECT_EQ(checks_, 1);
  ASSERT_EQ(result->steps.size(), 2U);
  EXPECT_EQ(result->steps[0].verdict, sysid::Verdict::ambiguous);
  EXPECT_EQ(result->steps[0].experiment, "gauge_check");
  EXPECT_GT(result->steps[0].minutes, 9 - 1e-9);
  EXPECT_EQ(result->spent_minutes, result->steps[0].minutes);
  EXPECT_TRUE(fs::exists(folder_ / "step_1" / "gauge.csv"));
  const auto json = result::json_of(fields_of(*result, "a test"));
  EXPECT_EQ(json["steps"][0]["experiment"]["waveform"], "gauge_check");
  EXPECT_TRUE(json["steps"][0]["experiment"]["predicted_separation_sigma"].is_null());
  EXPECT_EQ(json["steps"][0]["experiment"]["log"], (folder_ / "step_1" / "gauge.csv").string());
  EXPECT_EQ(json["gauge"]["sha256"].get<std::string>().size(), 64U);

  ASSERT_TRUE(result->gauge);
  options_.diagnosis.gauge = result->gauge;
  const auto again = investigate(options_);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->end, InvestigationEnd::settled);
  EXPECT_EQ(again->spent_minutes, 0);
  EXPECT_EQ(checks_, 1) << "the gauge file exists, so no new check is needed";
}

TEST_F(GaugeStepTest, EndsWithAdviceIfNoGaugeCheckIsPossible) {
  options_.take_gauge = nullptr;
  const auto result = investigate(options_);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->end, InvestigationEnd::nothing_left);
  EXPECT_NE(result->why.find("--gauge gauge_positions.csv"), std::string::npos) << result->why;
  EXPECT_TRUE(fs::exists(folder_ / "step_1" / "gauge_positions.csv"));
}

TEST_F(GaugeStepTest, DoesNotCheckTheGaugeBeyondTheTimeBudget) {
  options_.budget_minutes = 5;
  const auto result = investigate(options_);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->end, InvestigationEnd::budget_spent);
  EXPECT_EQ(checks_, 0);
}

TEST_F(GaugeStepTest, ARefusedCheckStopsAndAFailedCheckFails) {
  for (const bool stops : {true, false}) {
    options_.take_gauge = [&](const std::vector<double>&,
                              const std::string&) -> tl::expected<sysid::GaugeFile, NotPlayed> {
      return tl::unexpected(NotPlayed{stops, "because", ExitCode::io});
    };
    const auto result = investigate(options_);
    ASSERT_TRUE(result);
    EXPECT_EQ(result->end, stops ? InvestigationEnd::stopped : InvestigationEnd::failed);
    EXPECT_EQ(result->why, "because");
    EXPECT_EQ(result->code, ExitCode::io);
    EXPECT_EQ(result->spent_minutes, 0);
  }
}

TEST_F(GaugeStepTest, DoesNotRepeatAnInconclusiveGaugeCheck) {
  options_.take_gauge = [this](const std::vector<double>& positions_mm, const std::string& folder) {
    ++checks_;
    std::vector<sysid::GaugeReading> readings;
    for (const double p : positions_mm)
      readings.push_back({p, p + 3 * std::sin(7.0 * static_cast<double>(readings.size())), 1});
    return gauge_file_of(readings, folder);
  };
  const auto result = investigate(options_);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->end, InvestigationEnd::nothing_left);
  EXPECT_EQ(checks_, 1);
  EXPECT_NE(result->why.find("The gauge check was not conclusive"), std::string::npos) << result->why;
}

TEST(SimulatedGauge, ReadsTheNonlinearSensorWithoutTheFinger) {
  ExperimentRig rig = simulated_rig();
  auto& channel = std::get<simulation::SimulatedBoardSettings>(rig.rig.board).channels[rig.channel];
  channel.plant.model = model::with_block(
      model::with_block(channel.plant.model, {sysid::find_cause("stiffening")->forms.front().type, {0.02}}),
      {sysid::find_cause("sensor_nonlinearity")->forms.front().type, {1.5, 0, 20}});
  const ScratchFolder scratch;
  const fs::path folder = scratch.path();
  const auto gauge = simulated_gauge(rig)({0, 10, 20, 10, 100}, folder.string());
  ASSERT_TRUE(gauge) << gauge.error().why;
  ASSERT_EQ(gauge->readings.size(), 4U)
      << "the position of 100 mm is outside the range of the simulated sensor";
  const double expected_mm[]{0, 11.5, 20, 11.5};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(gauge->readings[i].reading_mm, expected_mm[i], 0.015);
    EXPECT_EQ(gauge->readings[i].samples, 200);
  }
  EXPECT_NE(gauge->readings[1].reading_mm, gauge->readings[3].reading_mm) << "the readings contain noise";
}

TEST(CommandGauge, RunsTheCommandWithPositionsAndReadsTheGaugeFile) {
  const ScratchFolder scratch;
  const fs::path folder = scratch.path() + "/gauge's folder";
  fs::create_directories(folder);
  const auto allow = [](const std::string&) { return true; };
  const std::string awk = R"(f() { awk -F, 'NR==1{print} NR>1{print $1 "," 1.1*$1}' "$1" > "$2"; }; f)";
  const auto gauge = command_gauge(awk, allow)({0, 10, 20}, folder.string());
  ASSERT_TRUE(gauge) << gauge.error().why;
  EXPECT_EQ(gauge->readings[2], (sysid::GaugeReading{20, 22, 1}));
  EXPECT_EQ(gauge->path, (folder / "gauge.csv").string());
  const auto unfilled = command_gauge("cp", allow)({0, 10, 20}, folder.string());
  ASSERT_FALSE(unfilled);
  EXPECT_NE(unfilled.error().why.find("refused"), std::string::npos);
  EXPECT_FALSE(command_gauge("false", allow)({0, 10, 20}, folder.string()));
  const auto refused =
      command_gauge("touch called;", [](const std::string&) { return false; })({0, 1, 2}, folder.string());
  ASSERT_FALSE(refused);
  EXPECT_TRUE(refused.error().stopped);
}

}  // namespace
}  // namespace softgrip::tools::investigation_test
