#include "sysid/logs/first_command.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace softgrip::sysid::first_command_test {
namespace {

/// Returns a log of 20 s at 50 Hz. The command is 0 for 2 s, and then a triangle up to 40 kPa. The pressure
/// before the log is `before_kpa`, and the displacement follows with a lag of 1 s.
Log log_after(double before_kpa) {
  Log log;
  double pressure_kpa = before_kpa;
  for (int i = 0; i < 1000; ++i) {
    const double t_s = 0.02 * i, motion_s = std::max(0.0, t_s - 2);
    const double command_kpa = 10 * (4 - std::abs(std::fmod(motion_s, 8.0) - 4));
    log.time_s.push_back(t_s);
    log.pressure_command_kpa.push_back(command_kpa);
    log.displacement_mm.push_back(0.3 * pressure_kpa + 0.01 * std::sin(7.0 * i));
    pressure_kpa += 0.02 * (command_kpa - pressure_kpa);
  }
  return log;
}

Log beginning_with(Log log, double command_kpa, std::size_t samples) {
  std::fill_n(log.pressure_command_kpa.begin(), samples, command_kpa);
  return log;
}

TEST(WrongFirstCommand, IsFoundIfTheReadingsBelongToTheNextCommand) {
  for (const std::size_t samples : {1U, 4U}) {
    for (const double command_kpa : {30.0, 200.0}) {
      const auto found = wrong_first_command(beginning_with(log_after(0), command_kpa, samples));
      ASSERT_TRUE(found) << samples << " samples with " << command_kpa << " kPa";
      EXPECT_EQ(found->samples, samples);
      EXPECT_EQ(found->command_kpa, command_kpa);
      EXPECT_EQ(found->next_kpa, 0);
    }
  }
}

TEST(WrongFirstCommand, CommandBeforeAStepIsCorrect) {
  EXPECT_FALSE(wrong_first_command(beginning_with(log_after(30), 30, 1)))
      << "the finger begins at 30 kPa and vents slowly";
  EXPECT_FALSE(wrong_first_command(log_after(0)));
  EXPECT_FALSE(wrong_first_command(beginning_with(log_after(0), 30, 5))) << "5 samples are a pulse";
  EXPECT_FALSE(wrong_first_command(beginning_with(log_after(0), 3, 1))) << "3 kPa are near 0 kPa";
}

TEST(WrongFirstCommand, ShortSecondCommandLeavesTheFirstOneUnchanged) {
  Log log = beginning_with(log_after(0), 30, 1);
  for (std::size_t i = 15; i < 40; ++i) log.pressure_command_kpa[i] = 20;
  EXPECT_FALSE(wrong_first_command(log));
}

}  // namespace
}  // namespace softgrip::sysid::first_command_test
