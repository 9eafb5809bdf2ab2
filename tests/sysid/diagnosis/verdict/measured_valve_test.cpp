#include "sysid/diagnosis/verdict/measured_valve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace softgrip::sysid::measured_valve_test {
namespace {

constexpr double sample_s = 0.01, gain = 1.05, zero_kpa = 2.0, noise_kpa = 0.2;
constexpr std::size_t block_samples = 800;  // block length of 8 s

// Returns the log of a valve without dynamics. The measured pressure is a linear function of the command,
// plus noise and an offset that is constant within each block.
Log straight_log(std::size_t blocks, double offset_kpa, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Log log;
  double offset = 0;
  for (std::size_t i = 0; i < blocks * block_samples; ++i) {
    if (i % block_samples == 0) offset = offset_kpa * normal(random);
    const double t = sample_s * static_cast<double>(i);
    log.time_s.push_back(t);
    log.pressure_command_kpa.push_back(40 + 30 * std::sin(2 * std::numbers::pi * 0.031 * t));
    log.displacement_mm.push_back(0);
    log.pressure_kpa.push_back(gain * log.pressure_command_kpa.back() + zero_kpa + offset +
                               noise_kpa * normal(random));
  }
  return log;
}

/// Returns the index of the block that contains a sample. The log is one sampling interval shorter than a
/// whole number of blocks, so the samples of its incomplete last block belong to the block before.
std::size_t block_of(const Log& log, std::size_t sample) {
  return std::min(sample / block_samples, log.size() / block_samples - 2);
}

struct Line {
  double slope, zero;
};
/// Returns the regression line through the samples of every second block. It is computed in closed form.
Line line_through(const Log& log, bool even) {
  double n = 0, su = 0, sp = 0, suu = 0, sup = 0;
  for (std::size_t i = 0; i < log.size(); ++i) {
    if ((block_of(log, i) % 2 == 0) != even) continue;
    const double u = log.pressure_command_kpa[i], p = log.pressure_kpa[i];
    n += 1, su += u, sp += p, suu += u * u, sup += u * p;
  }
  const double slope = (sup - su * sp / n) / (suu - su * su / n);
  return {slope, (sp - slope * su) / n};
}

TEST(MeasuredValve, HeldOutLossComesFromAFitToTheOtherBlocks) {
  const std::vector<Log> logs{straight_log(8, 0.5, 3)};
  const MeasuredValve valve(logs, false);
  const BlockLosses losses = valve.held_out_losses({}, valve.fit({}, {ValveStage{}}));
  ASSERT_EQ(losses.size(), 7U);
  // The first block is not compared. The simulation of the valve starts at the first measured pressure. The
  // model then applies the gain and the zero offset of the sensor to this pressure a second time.
  for (std::size_t block = 1; block < 6; ++block) {
    const Line line = line_through(logs[0], block % 2 == 1);
    double sum_kpa2 = 0;
    for (std::size_t i = block * block_samples; i < (block + 1) * block_samples; ++i) {
      const double error = line.slope * logs[0].pressure_command_kpa[i] + line.zero - logs[0].pressure_kpa[i];
      sum_kpa2 += error * error;
    }
    EXPECT_NEAR(losses[block], sum_kpa2 / block_samples, 0.02 * losses[block]) << block;
  }
}

TEST(MeasuredValve, ASlowLogHasLongerBlocks) {
  const auto blocks_with = [](double factor) {
    std::vector<Log> logs{straight_log(8, 0.5, 3)};
    for (double& t : logs[0].time_s) t *= factor;
    const MeasuredValve valve(logs, false);
    return valve.held_out_losses({}, ValveStage{}).size();
  };
  EXPECT_EQ(blocks_with(1e3), blocks_with(1e5));
  EXPECT_LT(blocks_with(1e3), 20U) << "a block of 8 s would be a part of one sample";
}

TEST(MeasuredValve, GaugeStandardErrorsMatchALinearRegression) {
  const std::vector<Log> logs{straight_log(40, 0, 5)};
  const MeasuredValve valve(logs, false);
  const ValveStage stage = valve.exact_fit({}, {ValveStage{}});
  const auto errors = valve.standard_errors(stage, {&ValveStage::gauge_gain, &ValveStage::gauge_zero_kpa});
  double su = 0, suu = 0;
  const double n = static_cast<double>(logs[0].size());
  for (const double u : logs[0].pressure_command_kpa) su += u, suu += u * u;
  const double about_mean = suu - su * su / n;
  const double of_gain = noise_kpa / std::sqrt(about_mean);
  const double of_zero = noise_kpa * std::sqrt(suu / (n * about_mean));
  EXPECT_NEAR(stage.gauge_gain, gain, 4 * of_gain);
  EXPECT_NEAR(stage.gauge_zero_kpa, zero_kpa, 4 * of_zero);
  // The standard errors must be at least 97 % of those for white noise. Each standard error is estimated from
  // 40 blocks, so it is uncertain by about 10 %.
  EXPECT_GT(errors[0], 0.97 * of_gain);
  EXPECT_LT(errors[0], 1.4 * of_gain);
  EXPECT_GT(errors[1], 0.97 * of_zero);
  EXPECT_LT(errors[1], 1.4 * of_zero);
}

TEST(MeasuredValve, BlockwiseOffsetRaisesTheStandardError) {
  const std::vector<Log> white{straight_log(40, 0, 7)}, lasting{straight_log(40, noise_kpa, 7)};
  const auto error_of = [](const std::vector<Log>& logs) {
    const MeasuredValve valve(logs, false);
    return valve.standard_errors(valve.exact_fit({}, {ValveStage{}}),
                                 {&ValveStage::gauge_gain, &ValveStage::gauge_zero_kpa})[1];
  };
  // Each of the 40 blocks has its own random offset, which is as large as the noise. The log therefore
  // contains as much information about the zero offset as 40 readings, not as 32,000 readings.
  EXPECT_GT(error_of(lasting), 10 * error_of(white));
  EXPECT_LT(error_of(lasting), 60 * error_of(white));
}

constexpr double low_noise_kpa = 0.05;

/// Returns one log of a valve without dynamics. The pressure depends only on the command at the same sample.
std::vector<Log> logs_of(const std::function<double(double)>& pressure_kpa) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  Log log;
  for (int i = 0; i < 6400; ++i) {
    const double t = sample_s * i;
    const double u = 30 - 30 * std::cos(2 * std::numbers::pi * 0.05 * t);
    log.time_s.push_back(t);
    log.pressure_command_kpa.push_back(u);
    log.displacement_mm.push_back(0);
    log.pressure_kpa.push_back(pressure_kpa(u) + low_noise_kpa * normal(random));
  }
  return {log};
}

std::optional<LostPressure> lost_of(const std::vector<Log>& logs) {
  const MeasuredValve valve(logs, false);
  return find_lost_pressure(logs, valve, {}, valve.fit({}, {ValveStage{}}));
}

TEST(FindLostPressure, ReportsTheMissingPressureAtTheHighestCommand) {
  const auto lost = lost_of(logs_of([](double u) { return 0.97 * u; }));
  ASSERT_TRUE(lost);
  EXPECT_NEAR(lost->highest_kpa, 0.97 * 60, 5 * low_noise_kpa);
  EXPECT_NEAR(lost->missing_kpa, 0.03 * 60, 0.3);
  EXPECT_EQ(lost->stage.gauge_gain, 1);
  EXPECT_TRUE(lost->parts.test(index_of(ValvePart::leak)));
  EXPECT_LT(rmse_mm(lost->losses_kpa2), 0.3 * rmse_mm(lost->without_kpa2));
}

TEST(FindLostPressure, IsAbsentForAScaleWithinToleranceOrAboveOne) {
  for (const double scale : {0.99, 1.0, 1.05})
    EXPECT_FALSE(lost_of(logs_of([&](double u) { return scale * u; }))) << scale;
}

TEST(FindLostPressure, IsAbsentForAConstantOffset) {
  EXPECT_FALSE(lost_of(logs_of([](double u) { return u - 3; })));
}

// The measured pressure does not exceed 52 kPa, even if the command does. A scale error of the pressure
// sensor explains half of the difference. A leak explains less, because it bends the curve of pressure over
// command in the opposite direction. Therefore no leak may be reported.
TEST(FindLostPressure, IsAbsentForAPressureLimit) {
  const std::vector<Log> logs = logs_of([](double u) { return std::min(u, 52.0); });
  const MeasuredValve valve(logs, false);
  ASSERT_LT(valve.fit({}, {ValveStage{}}).gauge_gain, 1 - scales_agree_within);
  EXPECT_FALSE(lost_of(logs));
}

TEST(FindLostPressure, IsAbsentIfMostOfTheErrorHasAnotherCause) {
  EXPECT_FALSE(lost_of(logs_of([](double u) { return 0.97 * u + 2 * std::sin(u); })));
}

}  // namespace
}  // namespace softgrip::sysid::measured_valve_test
