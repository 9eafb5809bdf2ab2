#include "tools/investigation/experiment_rig.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "model/file/model_file.h"
#include "sysid/diagnosis/experiments/waveform.h"
#include "sysid/logs/simulated_log.h"

namespace softgrip::tools::experiment_check_test {
namespace {

constexpr double interval_s = 0.02;

model::Model twin() {
  document::Problems problems;
  return model::load_model(SOFTGRIP_SOURCE_DIR "/config/models/bench_twin.yaml", problems).value();
}

sysid::Log played(const std::vector<double>& command_kpa) {
  sysid::Log log;
  log.name = "played";
  log.pressure_command_kpa = command_kpa;
  for (std::size_t i = 0; i < command_kpa.size(); ++i)
    log.time_s.push_back(static_cast<double>(i) * interval_s);
  simulate(twin(), {0.05, 3}, log);
  return log;
}

const sysid::RigLimits limits{50, 300};

TEST(ExperimentCheck, AcceptsEveryCorrectlyExecutedExperiment) {
  for (const sysid::Waveform& waveform : sysid::experiment_menu(limits)) {
    sysid::Log log = played(sysid::sampled_kpa(waveform, interval_s));
    EXPECT_EQ(broken_promise(waveform, log), std::nullopt) << waveform.name;
    EXPECT_EQ(touched(sysid::validate_logs(twin(), {log}), log, 50), std::nullopt) << waveform.name;
  }
}

TEST(ExperimentCheck, RefusesAShortenedClippedOrDisturbedExperiment) {
  const sysid::Waveform waveform = sysid::experiment_menu(limits).front();
  const sysid::Log log = played(sysid::sampled_kpa(waveform, interval_s));
  const auto sentence = [&](const sysid::Log& other) { return broken_promise(waveform, other).value_or(""); };
  EXPECT_NE(sentence(sysid::slice(log, 0, log.size() / 2)).find("it took"), std::string::npos);
  sysid::Log clipped = log;
  for (double& p : clipped.pressure_command_kpa) p = std::min(p, 40.0);
  EXPECT_NE(sentence(clipped).find("went to 40 instead of"), std::string::npos) << sentence(clipped);
  sysid::Log restless = log;
  for (std::size_t i = 0; i < restless.size(); i += 2)
    restless.pressure_command_kpa[i] = std::max(0.0, restless.pressure_command_kpa[i] - 1);
  EXPECT_NE(sentence(restless).find("changed by a total of"), std::string::npos) << sentence(restless);
}

TEST(ExperimentCheck, DetectsAnObstacleButAcceptsASofterFinger) {
  for (const sysid::Waveform& waveform : sysid::experiment_menu(limits)) {
    const sysid::Log log = played(sysid::sampled_kpa(waveform, interval_s));
    const double top_mm = *std::max_element(log.displacement_mm.begin(), log.displacement_mm.end());
    sysid::Log softer = log, stopped = log;
    for (double& y : softer.displacement_mm) y *= 1.15;
    for (double& y : stopped.displacement_mm) y = std::min(y, 0.6 * top_mm);
    EXPECT_EQ(touched(sysid::validate_logs(twin(), {softer}), softer, 50), std::nullopt) << waveform.name;
    EXPECT_NE(touched(sysid::validate_logs(twin(), {stopped}), stopped, 50), std::nullopt) << waveform.name;
  }
}

}  // namespace
}  // namespace softgrip::tools::experiment_check_test
