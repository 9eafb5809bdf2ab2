#include "sysid/logs/record.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace softgrip::sysid::record_test {
namespace {

constexpr double noise_mm = 0.02;

/// Returns a log of 20 s at 50 Hz. The command is 0 for the first `rest_s`, and then a slow triangle. The
/// readings have noise and an offset.
Log beginning_at_rest(double rest_s, double offset_mm) {
  std::mt19937 random(11);
  std::normal_distribution<double> noise(0, noise_mm);
  Log log;
  for (int i = 0; i < 1000; ++i) {
    const double t_s = 0.02 * i, motion_s = std::max(0.0, t_s - rest_s);
    log.time_s.push_back(t_s);
    log.pressure_command_kpa.push_back(10 * (4 - std::abs(std::fmod(motion_s, 8.0) - 4)));
    log.displacement_mm.push_back(0.3 * log.pressure_command_kpa.back() + offset_mm + noise(random));
  }
  return log;
}

bool has_offset(const Log& log) {
  return make_records({log}, {})[0].offset_free;
}

TEST(RecordOffset, IsEstimatedIfTheReadingsBeforeTheMotionAreNotZero) {
  EXPECT_FALSE(has_offset(beginning_at_rest(2, 0)));
  EXPECT_TRUE(has_offset(beginning_at_rest(2, 5)));
  EXPECT_TRUE(has_offset(beginning_at_rest(2, 3 * noise_mm)))
      << "100 readings show an offset of three standard deviations of one reading";
}

TEST(RecordOffset, IsNotDeterminedByOneWrongReading) {
  for (const double rest_s : {2.0, 0.0}) {
    Log shifted = beginning_at_rest(rest_s, 5);
    shifted.displacement_mm[0] = 0;
    EXPECT_TRUE(has_offset(shifted)) << "only the first reading is 0, the rest lasts " << rest_s << " s";
  }
  Log log = beginning_at_rest(2, 0);
  log.displacement_mm[0] = 5;
  EXPECT_FALSE(has_offset(log)) << "only the first reading is not 0";
}

/// Returns every tenth sample of the log, so that the command changes from the first sample to the second.
Log every_tenth(const Log& log) {
  Log few;
  for (std::size_t i = 0; i < log.size(); i += 10) {
    few.time_s.push_back(log.time_s[i]);
    few.pressure_command_kpa.push_back(log.pressure_command_kpa[i]);
    few.displacement_mm.push_back(log.displacement_mm[i]);
  }
  return few;
}

TEST(ReadingCount, MissingReadingsDoNotCount) {
  const Log whole = beginning_at_rest(2, 0);
  Log gap = whole;
  gap.displacement_mm[3] = std::nan("");
  EXPECT_EQ(reading_count(make_records({whole, gap}, {})), 2 * whole.size() - 1);
  EXPECT_EQ(reading_count({}), 0U);
}

TEST(RecordOffset, MotionFromTheFirstSampleIsNoOffset) {
  EXPECT_FALSE(has_offset(beginning_at_rest(0, 0)));
  EXPECT_FALSE(has_offset(every_tenth(beginning_at_rest(0, 0))));
  Log shifted = every_tenth(beginning_at_rest(0, 5));
  shifted.displacement_mm[0] = 0;
  EXPECT_TRUE(has_offset(shifted)) << "the step to the second reading is larger than all other steps";
}

bool has_unknown_start(const Log& log) {
  return make_records({log}, {})[0].start_unknown;
}

Log with_command_offset(Log log, double offset_kpa) {
  for (double& command_kpa : log.pressure_command_kpa) command_kpa += offset_kpa;
  return log;
}

TEST(RecordStart, IsARestIfTheReadingsAreSteadyAtASmallPressure) {
  EXPECT_FALSE(has_unknown_start(beginning_at_rest(2, 0)));
  const Log offset = with_command_offset(beginning_at_rest(2, 0), 1);  // 2.4 % of the largest command
  EXPECT_FALSE(has_unknown_start(offset));
  EXPECT_TRUE(has_offset(offset)) << "the displacement at 1 kPa is unknown";
}

TEST(RecordStart, IsUnknownDuringMotionAndUnderPressure) {
  EXPECT_TRUE(has_unknown_start(with_command_offset(beginning_at_rest(0, 0), 1)))
      << "the command moves from the first sample on";
  EXPECT_TRUE(has_unknown_start(with_command_offset(beginning_at_rest(2, 0), 10)));
  Log creeping = with_command_offset(beginning_at_rest(2, 0), 1);
  for (std::size_t i = 0; i < creeping.size(); ++i)
    creeping.displacement_mm[i] += 2 * std::exp(-creeping.time_s[i] / 2);
  EXPECT_TRUE(has_unknown_start(creeping)) << "the finger creeps after an earlier motion";
}

}  // namespace
}  // namespace softgrip::sysid::record_test
