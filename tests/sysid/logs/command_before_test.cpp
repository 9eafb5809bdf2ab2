#include "sysid/logs/command_before.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

namespace softgrip::sysid::command_before_test {
namespace {

constexpr double interval_s = 0.02;

/// Returns a log that begins two samples after a step of the command from `idle_kpa` to 60 kPa. The command
/// stays at 60 kPa for 4 s and then follows a slow cosine. The pressure follows the command with a lag of 0.3
/// s. The pressure reading is `offset_kpa` too high.
Log begun_at_a_step(double idle_kpa, double offset_kpa = 0) {
  Log log;
  double pressure_kpa = idle_kpa;
  for (int i = -2; i < 1000; ++i) {
    const double t_s = interval_s * i;
    const double command_kpa = t_s < 4 ? 60 : 40 + 20 * std::cos(2 * std::numbers::pi * 0.1 * (t_s - 4));
    pressure_kpa += (command_kpa - pressure_kpa) * interval_s / 0.3;
    if (i < 0) continue;
    log.time_s.push_back(t_s);
    log.pressure_command_kpa.push_back(command_kpa);
    log.pressure_kpa.push_back(pressure_kpa + offset_kpa);
    log.displacement_mm.push_back(0.3 * pressure_kpa);
    log.temperature_c.push_back(21 + 0.001 * i);
  }
  log.others.push_back({"operator", std::vector<std::string>(log.size(), "A")});
  return log;
}

TEST(CommandBefore, IsEstimatedFromTheFirstMeasuredPressure) {
  const Log log = begun_at_a_step(7);
  const auto before_kpa = pressure_before_kpa(log);
  ASSERT_TRUE(before_kpa);
  EXPECT_EQ(*before_kpa, log.pressure_kpa.front());
  const auto vented = pressure_before_kpa(begun_at_a_step(90));
  ASSERT_TRUE(vented);
  EXPECT_GT(*vented, 75) << "the earlier pressure must also be found if the command was lowered";
}

TEST(CommandBefore, IsACommandThatTheLogContains) {
  Log log = begun_at_a_step(7);
  for (std::size_t i = 250; i < log.size(); ++i) log.pressure_command_kpa[i] = i % 200 < 100 ? 0 : 60;
  const auto before_kpa = pressure_before_kpa(log);
  ASSERT_TRUE(before_kpa);
  EXPECT_GT(log.pressure_kpa.front(), 5);
  EXPECT_EQ(*before_kpa, 0) << "the log contains only the commands 0 and 60 kPa after the first hold";
}

TEST(CommandBefore, LogThatBeginsAtRestHasNoEarlierCommand) {
  EXPECT_FALSE(pressure_before_kpa(begun_at_a_step(60)));
  EXPECT_FALSE(pressure_before_kpa(begun_at_a_step(58)))
      << "a difference of 2 kPa may be an error of the regulator";
  Log unread = begun_at_a_step(7);
  unread.pressure_kpa.front() = std::nan("");
  EXPECT_FALSE(pressure_before_kpa(unread));
}

Log unmeasured(Log log) {
  log.pressure_kpa.clear();
  return log;
}

TEST(CommandBefore, DisplacementSelectsTheLowestOrHighestCommand) {
  const auto [least, most] = std::pair{20.0, 60.0};  // lowest and highest command of the cosine [kPa]
  const auto risen = pressure_before_kpa(unmeasured(begun_at_a_step(7)));
  ASSERT_TRUE(risen);
  EXPECT_NEAR(*risen, least, 0.1);
  Log lowered = begun_at_a_step(60);  // the command falls from 60 to 20 kPa at the start of the log
  for (std::size_t i = 0; i < lowered.size(); ++i) {
    lowered.pressure_command_kpa[i] = 80 - lowered.pressure_command_kpa[i];
    const double settling = std::exp(-interval_s * static_cast<double>(i) / 0.3);
    lowered.displacement_mm[i] = 0.3 * (lowered.pressure_command_kpa[i] + 40 * settling);
  }
  const auto fallen = pressure_before_kpa(unmeasured(lowered));
  ASSERT_TRUE(fallen);
  EXPECT_NEAR(*fallen, most, 0.1);
}

TEST(CommandBefore, UnclearDisplacementGivesNoEarlierCommand) {
  EXPECT_FALSE(pressure_before_kpa(unmeasured(begun_at_a_step(60))))
      << "the finger is at rest at the start of the log, so no sample must be added";
  Log creeping = unmeasured(begun_at_a_step(60));
  for (std::size_t i = 0; i < creeping.size(); ++i)
    creeping.displacement_mm[i] -= 1.5 * std::exp(-interval_s * static_cast<double>(i));
  EXPECT_FALSE(pressure_before_kpa(creeping))
      << "creep of 12 % of the span must not count as a response to a step of the command";
  Log brief = unmeasured(begun_at_a_step(7));
  for (std::size_t i = 19; i < brief.size(); ++i) brief.pressure_command_kpa[i] = 20;
  EXPECT_FALSE(pressure_before_kpa(brief)) << "the command is held for 19 samples only";
  Log lowest = unmeasured(begun_at_a_step(7));
  for (double& command : lowest.pressure_command_kpa) command = 120 - command;
  EXPECT_FALSE(pressure_before_kpa(lowest))
      << "the displacement rises although the first command is the lowest of the log";
  Log unread = unmeasured(begun_at_a_step(7));
  for (double& reading : unread.displacement_mm) reading = std::nan("");
  EXPECT_FALSE(pressure_before_kpa(unread));
}

TEST(CommandBefore, OffsetOfThePressureSensorIsNoTransient) {
  EXPECT_FALSE(pressure_before_kpa(begun_at_a_step(60, 25)));
  EXPECT_FALSE(pressure_before_kpa(begun_at_a_step(60, -25)));
}

TEST(CommandBefore, FirstCommandOfOneSampleGivesNoEarlierCommand) {
  Log log = begun_at_a_step(7);
  for (std::size_t i = 1; i < log.size(); ++i) log.pressure_command_kpa[i] = i < 100 ? 10 : 60;
  EXPECT_FALSE(pressure_before_kpa(log))
      << "the command was 60 kPa for only one sample, so the pressure did not reach 60 kPa";
}

TEST(CommandBefore, SingleSampleWithAnotherCommandDoesNotEndTheFirstCommand) {
  for (const bool is_measured : {true, false}) {
    Log log = begun_at_a_step(7);
    if (!is_measured) log = unmeasured(log);
    const auto before_kpa = pressure_before_kpa(log);
    ASSERT_TRUE(before_kpa);
    log.pressure_command_kpa[1] = 20;
    EXPECT_EQ(pressure_before_kpa(log), before_kpa) << "a pressure was measured: " << is_measured;
    log.pressure_command_kpa[2] = 20;
    EXPECT_FALSE(pressure_before_kpa(log)) << "two samples are a change of the command";
  }
}

TEST(CommandBefore, WrongCommandOfASingleSampleIsNoCommandOfTheLog) {
  for (const bool is_measured : {true, false}) {
    for (const double wrong : {999.0, -300.0}) {
      Log log = begun_at_a_step(7);
      if (!is_measured) log = unmeasured(log);
      const auto before_kpa = pressure_before_kpa(log);
      ASSERT_TRUE(before_kpa);
      log.pressure_command_kpa[500] = wrong;
      EXPECT_EQ(pressure_before_kpa(log), before_kpa)
          << wrong << ", a pressure was measured: " << is_measured;
    }
  }
}

TEST(CommandBefore, OutlierOfTheDisplacementHasNoEffect) {
  const auto before_kpa = pressure_before_kpa(unmeasured(begun_at_a_step(7)));
  ASSERT_TRUE(before_kpa);
  for (const std::size_t at : {2U, 198U, 500U}) {
    for (const double outlier_mm : {120.0, -1e4}) {
      Log log = unmeasured(begun_at_a_step(7));
      log.displacement_mm[at] = outlier_mm;
      EXPECT_EQ(pressure_before_kpa(log), before_kpa) << outlier_mm << " mm in sample " << at;
    }
  }
}

TEST(CommandBefore, IsAddedAsASampleWithoutReadings) {
  const Log log = begun_at_a_step(7);
  const Log longer = with_command_before(log, 7);
  ASSERT_EQ(longer.size(), log.size() + 1);
  EXPECT_EQ(longer.time_s.front(), 0);
  EXPECT_NEAR(longer.time_s[1], interval_s, 1e-12);
  EXPECT_EQ(longer.pressure_command_kpa.front(), 7);
  EXPECT_TRUE(std::isnan(longer.displacement_mm.front()));
  EXPECT_TRUE(std::isnan(longer.pressure_kpa.front()));
  EXPECT_EQ(longer.temperature_c.front(), log.temperature_c.front());
  EXPECT_TRUE(longer.supply_kpa.empty());
  EXPECT_EQ(longer.others.front().cells.size(), longer.size());
  for (std::size_t i = 0; i < log.size(); ++i) {
    EXPECT_NEAR(longer.time_s[i + 1] - log.time_s[i], interval_s, 1e-12);
    EXPECT_EQ(longer.displacement_mm[i + 1], log.displacement_mm[i]);
    EXPECT_EQ(longer.pressure_kpa[i + 1], log.pressure_kpa[i]);
  }
  ASSERT_EQ(longer.notes.size(), 1U);
  EXPECT_NE(longer.notes.front().text.find("from 7 to 60 kPa"), std::string::npos)
      << longer.notes.front().text;
}

}  // namespace
}  // namespace softgrip::sysid::command_before_test
