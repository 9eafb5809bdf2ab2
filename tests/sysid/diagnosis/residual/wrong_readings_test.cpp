#include "sysid/diagnosis/residual/wrong_readings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <random>

namespace softgrip::sysid::wrong_readings_test {
namespace {

/// Returns the log of a finger with a gain of 0.5 mm/kPa and with noise of 0.02 mm. The command consists of
/// triangles up to 40 kPa. Only every `every`-th sample has a reading.
Log moving(int every = 1) {
  Log log;
  log.name = "moving";
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 0.02);
  for (int i = 0; i < 2000; ++i) {
    const double t = 0.02 * i;
    const double kpa = 40 * std::max(0.0, 1 - std::abs(std::fmod(t, 10) / 4 - 1));
    log.time_s.push_back(t);
    log.pressure_command_kpa.push_back(kpa);
    log.displacement_mm.push_back(i % every == 0 ? 0.5 * kpa + noise(random)
                                                 : std::numeric_limits<double>::quiet_NaN());
  }
  return log;
}

/// Inserts the wrong readings into a log. Checks that the function under test removes exactly these readings
/// and returns one sentence that contains `number`.
void expect_taken_out(Log log, const std::map<std::size_t, double>& wrong, const std::string& number) {
  for (const auto& [sample, value] : wrong) log.displacement_mm[sample] = value;
  std::vector<Log> logs{moving(), log};
  const std::vector<Log> before = logs;
  const std::vector<std::string> sentences = take_out_wrong_readings(logs);
  ASSERT_EQ(sentences.size(), 1U);
  EXPECT_NE(sentences[0].find(number), std::string::npos) << sentences[0];
  for (std::size_t k = 0; k < logs.size(); ++k) {
    for (std::size_t i = 0; i < logs[k].size(); ++i) {
      const bool taken =
          std::isfinite(before[k].displacement_mm[i]) && !std::isfinite(logs[k].displacement_mm[i]);
      EXPECT_EQ(taken, k == 1 && wrong.count(i) > 0) << logs[k].time_s[i] << " s";
    }
  }
}

TEST(WrongReadings, ACodeIsTakenOutWhereverItStands) {
  expect_taken_out(moving(), {{0, 9999}, {1, 9999}, {700, 9999}, {1999, 9999}},
                   "4 of 2000 readings are outliers");
  expect_taken_out(moving(), {{500, -999}, {501, -999}, {502, -999}, {503, -999}}, "-999 mm at 10 s");
}

TEST(WrongReadings, IsolatedOnesAreTakenOutInASlowSensorToo) {
  expect_taken_out(moving(), {{300, 31.5}, {907, -22.5}, {1500, 44.5}}, "3 of 2000 readings are outliers");
  expect_taken_out(moving(20), {{300, 81.5}, {900, -22.5}, {1500, 44.5}}, "3 of 100 readings are outliers");
}

TEST(WrongReadings, TheFirstAndTheLastReadingMayBeOne) {
  expect_taken_out(moving(), {{0, 431.7}}, "1 of 2000 readings is an outlier");
  expect_taken_out(moving(), {{1999, -388.1}}, "-388.1 mm");
}

TEST(WrongReadings, AMotionHasNone) {
  Log step = moving();
  for (std::size_t i = 0; i < step.size(); ++i) {
    step.pressure_command_kpa[i] = i == 0 ? 0 : 40;
    step.displacement_mm[i] = (i < 2 ? 0 : 20) + 0.02 * std::sin(1.0 * static_cast<double>(i * i));
  }
  Log without_noise = moving();
  for (std::size_t i = 0; i < without_noise.size(); ++i)
    without_noise.displacement_mm[i] = 0.5 * without_noise.pressure_command_kpa[i];
  std::vector<Log> logs{moving(), moving(20), step, without_noise};
  const std::vector<Log> before = logs;
  EXPECT_TRUE(take_out_wrong_readings(logs).empty());
  for (std::size_t k = 0; k < logs.size(); ++k) {
    for (std::size_t i = 0; i < logs[k].size(); ++i)
      EXPECT_EQ(std::isfinite(logs[k].displacement_mm[i]), std::isfinite(before[k].displacement_mm[i]));
  }
}

}  // namespace
}  // namespace softgrip::sysid::wrong_readings_test
