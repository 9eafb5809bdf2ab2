#include "sysid/logs/first_readings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace softgrip::sysid::first_readings_test {
namespace {

constexpr double offset_mm = 5, none = std::numeric_limits<double>::quiet_NaN();

/// Returns a log of 40 s at 50 Hz: the command is 0 for 2 s, and then triangles up to 40 kPa. From sample
/// `first` on, the log is kept. The finger moves by 0.5 mm/kPa with a lag of 0.2 s.
Log moving(std::size_t first = 0) {
  Log log;
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 0.02);
  double pressure_kpa = 0;
  for (std::size_t i = 0; i < 2000; ++i) {
    const double t_s = 0.02 * static_cast<double>(i), motion_s = std::max(0.0, t_s - 2);
    const double command_kpa = 10 * (4 - std::abs(std::fmod(motion_s, 8.0) - 4));
    pressure_kpa += 0.1 * (command_kpa - pressure_kpa);
    const double reading_mm = offset_mm + 0.5 * pressure_kpa + noise(random);
    if (i < first) continue;
    log.time_s.push_back(t_s - 0.02 * static_cast<double>(first));
    log.pressure_command_kpa.push_back(command_kpa);
    log.displacement_mm.push_back(reading_mm);
  }
  return log;
}

Log beginning_with(Log log, double reading_mm, std::size_t samples) {
  std::fill_n(log.displacement_mm.begin(), samples, reading_mm);
  return log;
}

/// Returns a log whose command changes every second, and whose finger follows `late` samples later in one
/// step. Without `returns`, the command and the finger stay at the first step.
Log stepping(std::size_t late, bool returns) {
  Log log;
  const auto command_at = [&](std::size_t i) { return returns && i / 50 % 2 == 1 ? 0.0 : 40.0; };
  for (std::size_t i = 0; i < 2000; ++i) {
    log.time_s.push_back(0.02 * static_cast<double>(i));
    log.pressure_command_kpa.push_back(i == 0 ? 0 : command_at(i));
    log.displacement_mm.push_back(i < late + 1 ? 0.0 : 0.5 * command_at(i - late));
  }
  return log;
}

TEST(WrongFirstReadings, ReadingsOfASensorThatIsNotReadyAreFound) {
  for (const std::size_t first : {0U, 250U, 330U}) {  // at rest, in motion upwards, in motion downwards
    for (const std::size_t samples : {1U, 2U, 5U, 19U}) {
      for (const double reading_mm : {0.0, 60.0, -3.0}) {
        const auto found = wrong_first_readings(beginning_with(moving(first), reading_mm, samples));
        ASSERT_TRUE(found) << first << ' ' << samples << " samples with " << reading_mm << " mm";
        EXPECT_EQ(found->count, samples);
        EXPECT_EQ(found->samples, samples);
        EXPECT_EQ(found->last_mm, reading_mm);
      }
    }
  }
}

TEST(WrongFirstReadings, SamplesWithoutAReadingAreSkipped) {
  Log log = beginning_with(moving(), 0, 4);
  log.displacement_mm[0] = log.displacement_mm[2] = log.displacement_mm[4] = none;
  const auto found = wrong_first_readings(log);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->count, 2U);
  EXPECT_EQ(found->samples, 4U);
}

TEST(WrongFirstReadings, CorrectReadingsAreKept) {
  for (std::size_t first = 0; first < 900; first += 10)
    EXPECT_FALSE(wrong_first_readings(moving(first))) << "the log begins at sample " << first;
  EXPECT_FALSE(wrong_first_readings(beginning_with(moving(), 0, 20))) << "20 samples are a pulse";
  EXPECT_FALSE(wrong_first_readings(beginning_with(moving(), offset_mm + 0.1, 2))) << "within the noise";
}

TEST(WrongFirstReadings, StepOfTheCommandExplainsAJump) {
  for (const std::size_t late : {0U, 1U, 5U, 18U}) {
    for (const bool returns : {false, true}) {
      const Log log = stepping(late, returns);
      EXPECT_FALSE(wrong_first_readings(log)) << late << " samples late, returns: " << returns;
    }
  }
}

/// A log may begin with a step of the command, whose effect appears after a delay. The finger then moves
/// away from its first position and does not return to it. The sensor is slower than the log.
TEST(WrongFirstReadings, BeginningOfAMotionAfterADelayIsKept) {
  constexpr std::size_t held = 5;
  for (const std::size_t late : {3U, 9U, 18U}) {
    for (const double lag_samples : {5.0, 20.0, 100.0}) {
      Log log = moving();
      for (std::size_t i = 0; i < log.size(); ++i) {
        log.pressure_command_kpa[i] = i < 1000 ? 100 : 60;
        const auto since = i < late ? 0.0 : static_cast<double>((i - late) / held * held + held);
        log.displacement_mm[i] = 30 * (1 - std::exp(-since / lag_samples)) - (i < 1000 ? 0 : 5);
      }
      EXPECT_FALSE(wrong_first_readings(log)) << late << ' ' << lag_samples;
    }
  }
}

/// The pressure may rise although the command is constant, because the command changed before the log began.
TEST(WrongFirstReadings, StepOfTheMeasuredPressureExplainsAJump) {
  Log log = stepping(0, false);
  log.pressure_command_kpa[0] = 40;
  EXPECT_TRUE(wrong_first_readings(log));
  log.pressure_kpa = log.pressure_command_kpa;
  log.pressure_kpa[0] = 0;
  EXPECT_FALSE(wrong_first_readings(log));
}

TEST(WrongFirstReadings, ReadingThatTheFingerHasLaterIsKeptIfTheFingerIsAsFast) {
  Log log = stepping(3, true);
  log.pressure_command_kpa[0] = 40;
  EXPECT_FALSE(wrong_first_readings(log));
}

}  // namespace
}  // namespace softgrip::sysid::first_readings_test
