// Runs softgrip diagnose with the arguments that a user would give. The given model lacks a delay and a lag,
// the finger stiffens, or the logs contain too little information for a diagnosis. The logs with too little
// information are computed with separate formulas.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <random>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "model/file/model_file.h"
#include "tests/sysid/command_fixture.h"

namespace softgrip::sysid::command_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr double rate_hz = 50;

/// Returns a command that consists of triangles with a period of 10 s. Their heights are 50 kPa and 25 kPa in
/// turn.
double triangles_kpa(double t) {
  const double phase = std::fmod(t, 10) / 5;
  const double top = std::fmod(t, 20) < 10 ? 50 : 25;
  return top * (1 - std::abs(phase - 1));
}

class DiagnoseCommand : public CommandInFolder {
 protected:
  int diagnose(const std::string& logs) {
    return run("diagnose --model '" SOFTGRIP_SOURCE_DIR "/config/models/zhang2025.yaml' --data " + logs +
               " --out result --no-closed-loop");
  }
  Json diagnosis() { return Json::parse(read("result/diagnosis.json")); }
  [[nodiscard]] bool warned_of(const Json& json, const std::string& words) {
    return std::any_of(json["warnings"].begin(), json["warnings"].end(), [&](const Json& warning) {
      return warning.get<std::string>().find(words) != std::string::npos;
    });
  }

  /// Writes a log with a duration of `seconds` and a noise of 0.04 mm.
  void write_log(const std::string& name, double seconds, const std::function<double(double)>& command_kpa,
                 const std::function<double(double)>& displacement_mm) {
    std::mt19937_64 random(17);
    std::normal_distribution<double> noise(0, 0.04);
    std::string text = "time_s,pressure_command_kpa,displacement_mm\n";
    for (int i = 0; i < seconds * rate_hz; ++i) {
      const double t = i / rate_hz;
      text += std::to_string(t) + "," + std::to_string(command_kpa(t)) + "," +
              std::to_string(displacement_mm(t) + noise(random)) + "\n";
    }
    write(name, text);
  }
};

TEST_F(DiagnoseCommand, FindsDelayAndLagMissingFromThePublishedModel) {
  const std::string models = "'" SOFTGRIP_SOURCE_DIR "/config/models/";
  int seed = 0;
  for (const char* signal : {"tp1", "tp2", "sp2"}) {
    ASSERT_EQ(
        run("simulate --model " + models + "bench_twin.yaml' --input " + signal + " --noise-mm 0.04 --seed " +
            std::to_string(++seed) + " --rate-hz 50 --out " + signal + ".csv"),
        0)
        << read("err.txt");
  }
  ASSERT_EQ(run("diagnose --model " + models + "zhang2025.yaml' --data tp1.csv tp2.csv sp2.csv --out result"),
            0);
  const Json json = diagnosis();
  EXPECT_EQ(json["verdict"], "cause_found");
  ASSERT_EQ(json["causes"].size(), 2U);
  double delay_s = 0, lag_s = 0;
  for (const Json& cause : json["causes"]) {
    if (cause["id"] == "transport_delay") delay_s = cause["parameters"]["delay_s"]["value"];
    if (cause["id"] == "valve_lag") lag_s = cause["parameters"]["time_constant_s"]["value"];
  }
  EXPECT_NEAR(delay_s, 0.130, 0.003);
  EXPECT_NEAR(lag_s, 0.044, 0.005);
  EXPECT_TRUE(warned_of(json, "unphysical"));
  ASSERT_FALSE(json["closed_loop"].is_null());
  const double recalibrated_mm = json["closed_loop"]["recalibrated_rmse_mm"];
  const double extended_mm = json["closed_loop"]["extended_rmse_mm"];
  // The refitted model has no causal inverse. Its feedforward must therefore be planned before the run, and
  // its tracking error must be more than twice that of the extended model.
  EXPECT_GT(recalibrated_mm, 2 * extended_mm);
  EXPECT_EQ(run("check result/model.yaml"), 0) << read("out.txt") << read("err.txt");
}

/// Simulates a technician: runs a diagnosis, enters gauge readings into the proposed file, and repeats the
/// diagnosis.
TEST_F(DiagnoseCommand, GaugeReadingsSeparateStiffeningFromTheSensor) {
  const std::string twin = SOFTGRIP_SOURCE_DIR "/config/models/bench_twin.yaml";
  write("finger.yaml", read_file(twin, 100'000).value() + "  - stiffening:\n      stiffening_per_mm: 0.01\n");
  std::string logs;
  for (const std::string signal : {"tp1", "sp2"}) {
    logs += " " + signal + ".csv";
    ASSERT_EQ(run("simulate --model finger.yaml --rate-hz 50 --noise-mm 0.04 --input " + signal + " --out " +
                  signal + ".csv"),
              0)
        << read("err.txt");
  }
  const std::string command = "diagnose --model '" + twin + "' --no-closed-loop --out result --data" + logs;
  ASSERT_EQ(run(command), 0);
  EXPECT_EQ(diagnosis()["verdict"], "ambiguous");
  EXPECT_EQ(diagnosis()["gauge_check"]["file"], "gauge_positions.csv");
  EXPECT_NE(read("out.txt").find("--gauge gauge_positions.csv"), std::string::npos) << read("out.txt");
  EXPECT_EQ(run(command + " --gauge result/gauge_positions.csv"), 3)
      << "the gauge file contains no readings yet";
  EXPECT_EQ(run(command + " --gauge nowhere.csv"), 4);

  std::string filled = "gauge_mm,displacement_mm\n";
  const std::string asked = read("result/gauge_positions.csv");
  double error_mm = 0.03;
  for (std::size_t at = asked.find('\n') + 1; at < asked.size(); at = asked.find('\n', at) + 1) {
    const double position_mm = std::stod(asked.substr(at));
    filled +=
        asked.substr(at, asked.find(',', at) - at) + "," + std::to_string(position_mm + error_mm) + "\n";
    error_mm = -error_mm;
  }
  write("result/gauge_positions.csv", filled);
  ASSERT_EQ(run(command + " --gauge result/gauge_positions.csv"), 0) << read("err.txt");
  const Json json = diagnosis();
  EXPECT_EQ(json["verdict"], "cause_found");
  EXPECT_EQ(json["causes"][0]["id"], "stiffening");
  EXPECT_EQ(json["gauge"]["outcome"], "decided");
  EXPECT_EQ(json["gauge"]["ruled_out"], Json({"sensor_nonlinearity"}));
  EXPECT_TRUE(json["gauge_check"].is_null());
  EXPECT_EQ(read("result/gauge_positions.csv"), filled)
      << "the readings that the operator entered must remain in the gauge file";
  EXPECT_NE(read("out.txt").find("The gauge check shows that the sensor is linear"), std::string::npos);
  EXPECT_NE(read("result/report.html").find("Gauge check of the sensor"), std::string::npos);
}

TEST_F(DiagnoseCommand, AConstantInputIsRefused) {
  write_log(
      "constant.csv", 60, [](double) { return 20; }, [](double) { return 12; });
  EXPECT_EQ(diagnose("constant.csv"), 3);
  EXPECT_NE(read("err.txt").find("constant.csv:2:8: the command is 20 kPa from start to end"),
            std::string::npos);
  EXPECT_FALSE(fs::exists(folder_ / "result"));
}

TEST_F(DiagnoseCommand, TenSamplesAreRefused) {
  write_log("ten.csv", 0.2, triangles_kpa, [](double t) { return triangles_kpa(t) / 2; });
  EXPECT_EQ(diagnose("ten.csv"), 3);
  EXPECT_NE(read("err.txt").find("10 samples"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder_ / "result"));
}

TEST_F(DiagnoseCommand, AClippedLogIsRefused) {
  std::string text = "time_s,pressure_command_kpa,displacement_mm\n";
  for (int i = 0; i < 3000; ++i)
    text += std::to_string(i / rate_hz) + "," + std::to_string(triangles_kpa(i / rate_hz)) + ",5\n";
  write("clipped.csv", text);
  EXPECT_EQ(diagnose("clipped.csv"), 3);
  EXPECT_NE(read("err.txt").find("the displacement never changes"), std::string::npos) << read("err.txt");
  EXPECT_FALSE(fs::exists(folder_ / "result"));
}

TEST_F(DiagnoseCommand, TimeThatRunsBackwardsIsRefused) {
  std::string text = "time_s,pressure_command_kpa,displacement_mm\n";
  for (int i = 3000; i > 0; --i)
    text += std::to_string(i / rate_hz) + "," + std::to_string(triangles_kpa(i / rate_hz)) + "," +
            std::to_string(i % 7) + "\n";
  write("back.csv", text);
  EXPECT_EQ(diagnose("back.csv"), 3);
  EXPECT_NE(read("err.txt").find("the time goes back"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder_ / "result"));
}

TEST_F(DiagnoseCommand, WarnsOfLogsWithoutUnloading) {
  const auto ramp = [](double t) { return t; };
  write_log("loading.csv", 50, ramp, [](double t) { return 0.7 * t + 0.05 * std::pow(t, 1.2); });
  ASSERT_EQ(diagnose("loading.csv"), 0) << read("err.txt");
  EXPECT_TRUE(warned_of(diagnosis(), "the logs contain no unloading"));
}

TEST_F(DiagnoseCommand, WarnsOfLogsWithOnlyOneAmplitude) {
  const auto same = [](double t) { return 40 * (1 - std::abs(std::fmod(t, 10) / 5 - 1)); };
  write_log("same.csv", 80, same, [&](double t) { return 0.6 * same(t) + 0.002 * same(t) * same(t); });
  ASSERT_EQ(diagnose("same.csv"), 0) << read("err.txt");
  EXPECT_TRUE(warned_of(diagnosis(), "the logs contain only one amplitude"));
}

TEST_F(DiagnoseCommand, ReadingsUnrelatedToTheCommandAreRefused) {
  write_log("elsewhere.csv", 100, triangles_kpa,
            [](double t) { return 3 * std::sin(2.1 * t) + 2 * std::sin(5.3 * t); });
  EXPECT_EQ(diagnose("elsewhere.csv"), 3);
  EXPECT_NE(read("err.txt").find("do not follow the command"), std::string::npos) << read("err.txt");
  EXPECT_FALSE(fs::exists(folder_ / "result"));
}

TEST_F(DiagnoseCommand, LogsOfTwoRigsAreNotExplainedByOneCause) {
  const auto finger = [](double t) { return 0.6 * triangles_kpa(std::max(0.0, t - 0.1)); };
  write_log("left.csv", 80, triangles_kpa, finger);
  write_log("right.csv", 80, triangles_kpa, [&](double t) { return 1.7 * finger(t); });
  ASSERT_EQ(diagnose("left.csv right.csv"), 0) << read("err.txt");
  const Json json = diagnosis();
  EXPECT_EQ(json["verdict"], "unexplained");
  EXPECT_TRUE(json["causes"].empty());
  EXPECT_TRUE(warned_of(json, "all logs come from one rig")) << json["warnings"];
}

}  // namespace
}  // namespace softgrip::sysid::command_test
