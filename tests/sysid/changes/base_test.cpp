#include "sysid/changes/base.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "sysid/changes/base_prediction.h"
#include "sysid/changes/change.h"
#include "tests/sysid/changes/finger.h"

namespace softgrip::sysid::base_test {
namespace {

Base base_of(const std::vector<Log>& healthy) {
  return fit_base(make_records(healthy, {}), Judged::displacement, Drive::command, {});
}

/// Returns the RMS [mm] of the residual that the baseline model leaves in all logs. The mean residual of each
/// log is subtracted first.
double left_of_mm(const Base& base, const std::vector<Log>& logs) {
  const std::vector<Record> records = make_records(logs, {});
  const std::vector<std::vector<double>> left = residuals_of(base, records);
  double sum = 0, count = 0;
  for (std::size_t r = 0; r < records.size(); ++r) {
    const std::vector<double> series = binned(records[r], left[r], base.bin_s);
    double mean = 0;
    for (const double v : series) mean += v / static_cast<double>(series.size());
    for (const double v : series) sum += (v - mean) * (v - mean);
    count += static_cast<double>(series.size());
  }
  return std::sqrt(sum / count);
}

/// A drift of the sensor zero does not depend on the command. A held-out block and the blocks next to it
/// contain the same drift. The filter bank must not fit this drift in the neighbouring blocks, because it
/// would then predict the drift in the held-out block.
TEST(Base, LaterResidualMatchesHeldOutResidualDespiteSensorDrift) {
  const test::Finger drifting{.drift_mm = 0.1};
  const Base base = base_of(test::logs_of(drifting, 1));
  EXPECT_GT(base.left_mm, 0.06);
  const double later_mm = left_of_mm(base, test::logs_of(drifting, 5));
  EXPECT_NEAR(later_mm, base.left_mm, 0.25 * base.left_mm);
}

TEST(Base, IsFittedToLogsOfAFewSeconds) {
  std::vector<Log> healthy = test::logs_of({}, 1);
  for (Log& log : healthy) log = slice(log, 0, 500);
  const Base base = base_of(healthy);
  EXPECT_TRUE(std::isfinite(base.left_mm));
  EXPECT_LT(base.left_mm, 0.2);
}

TEST(Base, CommandDriveUsesShorterBinsThanMeasuredPressure) {
  std::vector<Log> logs = test::logs_of({}, 1, true);
  for (Log& log : logs) {
    for (double& t : log.time_s) t /= 4;  // changes the sample rate to 200 Hz
  }
  EXPECT_DOUBLE_EQ(fit_base(pressure_records(logs, false), Judged::pressure, Drive::command, {}).bin_s, 0.02);
  EXPECT_DOUBLE_EQ(base_of(logs).bin_s, 0.02);
  const std::vector<Record> behind_it = make_records(logs, {.drive = Drive::measured});
  EXPECT_DOUBLE_EQ(fit_base(behind_it, Judged::displacement, Drive::measured, {}).bin_s, 0.05);
}

TEST(Base, AFastRigHasShorterBins) {
  std::vector<Log> logs = test::logs_of({}, 1, true);
  for (Log& log : logs) {
    for (double& t : log.time_s) t /= 1e4;
  }
  const std::vector<Record> fast = make_records(logs, {.drive = Drive::measured});
  EXPECT_LT(finger_bin_s(fast), fast.front().length_s() / 100);
  EXPECT_LT(fit_base(fast, Judged::displacement, Drive::measured, {}).bin_s, fast.front().length_s() / 100);
}

/// Returns copies of the logs whose readings come from a simulated finger behind a pressure regulator. The
/// response of this regulator is not a first-order lag.
std::vector<Log> behind_a_narrow_port(std::vector<Log> logs) {
  const Regulator narrow{
      .play_kpa = 0.3, .dead_kpa = 0.9, .full_kpa = 20, .port_per_s = 0.5, .tube_per_s = 2};
  std::mt19937 random(7);
  std::normal_distribution<double> noise_mm(0, 0.03);
  for (Log& log : logs) {
    const Record record = make_records({log}, {}).front();
    const std::vector<double> p = regulated(narrow, record, record.drive_kpa);
    double play = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
      play = std::clamp(play, p[i] - 3, p[i] + 3);
      log.displacement_mm[i] = 0.2 * (0.6 * p[i] + 0.4 * play) + noise_mm(random);
    }
  }
  return logs;
}

TEST(Base, IncludesARegulatorModelWithoutMeasuredPressure) {
  const std::vector<Log> healthy = behind_a_narrow_port(test::logs_of({}, 1));
  const Base base = base_of(healthy);
  EXPECT_TRUE(base.regulator.has_value());
  EXPECT_LT(left_of_mm(base, behind_a_narrow_port(test::logs_of({}, 5))), 0.04);
  const Record record = thinned_for(base, make_records(healthy, {}).front());
  const Driven driven = driven_by(base, record);
  EXPECT_EQ(predict_base(base, record, {}), predict_base(base, record, {}, &driven));
}

using test::Finger;
using test::logs_of;

DriveChoice choice_of(const std::vector<Log>& healthy) {
  return chosen_drive(make_records(healthy, {.drive = Drive::measured}),
                      make_records(healthy, {.drive = Drive::command}), 1);
}

/// Replaces the measured pressure by a pressure that depends on the rate of the command. A gauge in the
/// supply pipe of an actuator shows this kind of pressure if a flow drives the actuator.
std::vector<Log> with_gauge_in_the_pipe(std::vector<Log> logs) {
  std::mt19937 random(11);
  std::normal_distribution<double> noise(0, 0.2);
  for (Log& log : logs) {
    log.pressure_kpa.assign(log.size(), 20);
    for (std::size_t i = 1; i < log.size(); ++i)
      log.pressure_kpa[i] =
          20 + 10 * (log.pressure_command_kpa[i] - log.pressure_command_kpa[i - 1]) + noise(random);
  }
  return logs;
}

bool is_unused(const ChangeDiagnosis& d) {
  return std::any_of(d.warnings.begin(), d.warnings.end(), [](const std::string& warning) {
    return warning.find("pressure_kpa is not used") != std::string::npos;
  });
}

TEST(DriveChoice, UsesTheMeasuredPressureOfTheFinger) {
  EXPECT_EQ(choice_of(logs_of({.valve_lag_s = 0.3}, 1, true)).drive, Drive::measured);
}

TEST(DriveChoice, UsesTheCommandIfTheGaugeMissesTheFingerPressure) {
  const DriveChoice choice = choice_of(with_gauge_in_the_pipe(logs_of({}, 1)));
  EXPECT_LT(choice.by_command_mm, 0.5 * choice.by_pressure_mm);
  EXPECT_EQ(choice.drive, Drive::command);
}

TEST(DriveChoice, GainChangeIsFoundWithAnUnusedPressureGauge) {
  const auto healthy = with_gauge_in_the_pipe(logs_of({}, 1));
  const auto d = diagnose_change(healthy, with_gauge_in_the_pipe(logs_of({.gain = 0.2 * 1.05}, 5)));
  ASSERT_TRUE(d) << d.error();
  EXPECT_TRUE(is_unused(*d));
  ASSERT_FALSE(d->causes.empty()) << change_sentence(*d);
  EXPECT_EQ(d->causes[0].id, "ageing");
  EXPECT_NEAR(d->causes[0].size.value, 5, 0.6);
  EXPECT_EQ(d->readings.size(), 1U) << "the measured pressure must not be judged";
  const auto same = diagnose_change(healthy, with_gauge_in_the_pipe(logs_of({}, 5)));
  ASSERT_TRUE(same) << same.error();
  EXPECT_EQ(same->verdict, ChangeVerdict::unchanged) << change_sentence(*same);
}

TEST(DriveChoice, AUsefulPressureIsUsed) {
  const auto d =
      diagnose_change(logs_of({.valve_lag_s = 0.3}, 1, true), logs_of({.valve_lag_s = 0.3}, 5, true));
  ASSERT_TRUE(d) << d.error();
  EXPECT_FALSE(is_unused(*d));
  EXPECT_EQ(d->readings.size(), 2U);
}

}  // namespace

}  // namespace softgrip::sysid::base_test
