#include "sysid/changes/drive_choice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "sysid/changes/change.h"
#include "tests/sysid/changes/finger.h"

namespace softgrip::sysid::drive_choice_test {
namespace {

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
}  // namespace softgrip::sysid::drive_choice_test
