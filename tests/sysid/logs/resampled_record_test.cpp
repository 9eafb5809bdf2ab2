#include "sysid/logs/resampled_record.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace softgrip::sysid::resampled_record_test {
namespace {

/// Returns a record of 4 s, sampled at 1 kHz. The readings are a parabola over time with added noise.
Record parabola(double noise_mm) {
  std::mt19937_64 random(20261122);
  std::normal_distribution<double> noise(0, 1);
  Record record;
  for (int i = 0; i <= 4000; ++i) {
    const double t_s = 1e-3 * i;
    record.time_s.push_back(t_s);
    record.duration_s.push_back(i == 0 ? 0 : 1e-3);
    record.drive_kpa.push_back(10 * t_s);
    record.reading_mm.push_back(2 * t_s * t_s + noise_mm * noise(random));
  }
  record.sample_time_s = 1e-3;
  record.finest_interval_s = 1e-3;
  record.readings = record.size();
  return record;
}

/// Returns a record with the given command, sampled at 100 Hz. All readings are 0 mm.
Record commanded(const std::vector<double>& drive_kpa) {
  Record record;
  for (std::size_t i = 0; i < drive_kpa.size(); ++i) {
    record.time_s.push_back(0.01 * static_cast<double>(i));
    record.duration_s.push_back(i == 0 ? 0 : 0.01);
    record.largest_kpa = std::max(record.largest_kpa, drive_kpa[i]);
  }
  record.drive_kpa = drive_kpa;
  record.reading_mm.assign(drive_kpa.size(), 0);
  record.sample_time_s = 0.01;
  return record;
}

/// Returns the integral of the command over time [kPa s].
double integral_kpa_s(const Record& record) {
  double sum = 0;
  for (std::size_t i = 1; i < record.size(); ++i) {
    const double mean_kpa = (record.drive_kpa[i - 1] + record.drive_kpa[i]) / 2;
    sum += record.duration_s[i] * (record.held ? record.drive_kpa[i - 1] : mean_kpa);
  }
  return sum;
}

TEST(StridedRecord, StepKeepsTheIntegralOfTheCommand) {
  for (const bool held : {false, true}) {
    for (std::size_t step = 12; step < 16; ++step) {
      std::vector<double> drive_kpa(41, 0);
      std::fill(drive_kpa.begin() + static_cast<long>(step), drive_kpa.end(), 80);
      Record record = commanded(drive_kpa);
      record.held = held;
      const Record thin = thinned_record(record, 4);
      ASSERT_EQ(thin.size(), 11U);
      EXPECT_NEAR(integral_kpa_s(thin), integral_kpa_s(record), 1e-9) << step << (held ? " held" : "");
      for (std::size_t i = 0; i < thin.size(); ++i) {
        EXPECT_GE(thin.drive_kpa[i], 0)
            << "a value outside the range of the command would have a lasting effect on a finger with memory";
        EXPECT_LE(thin.drive_kpa[i], 80);
      }
    }
  }
}

TEST(StridedRecord, CornerOfTheCommandIsPreserved) {
  std::vector<double> drive_kpa;
  for (int i = 0; i <= 40; ++i) drive_kpa.push_back(50 - 0.5 * std::abs(i - 20));
  const Record thin = thinned_record(commanded(drive_kpa), 2);
  for (std::size_t i = 0; i < thin.size(); ++i) EXPECT_DOUBLE_EQ(thin.drive_kpa[i], drive_kpa[2 * i]);
}

TEST(StridedRecord, StartsWithTheFirstCommandOfTheRecord) {
  std::vector<double> drive_kpa(9, 60);
  drive_kpa[0] = 0;
  EXPECT_EQ(thinned_record(commanded(drive_kpa), 2).drive_kpa[0], 0);
}

TEST(AveragedRecord, KeepsMotionAndSampleTimes) {
  const Record averaged = averaged_to(parabola(0), 0.010);
  ASSERT_EQ(averaged.size(), 401U);
  EXPECT_EQ(averaged.readings, 401U);
  EXPECT_DOUBLE_EQ(averaged.sample_time_s, 0.010);
  for (std::size_t i = 0; i < averaged.size(); ++i) {
    const double t_s = averaged.time_s[i];
    EXPECT_NEAR(t_s, 0.010 * static_cast<double>(i), 1e-12);
    EXPECT_NEAR(averaged.drive_kpa[i], 10 * t_s, 1e-9);
    // The expected value is the mean of nine readings of a parabola at intervals of 1 ms. The mean exceeds
    // the parabola by half the second derivative times the mean square of the time offsets.
    EXPECT_NEAR(averaged.reading_mm[i], 2 * t_s * t_s, 2 * 6.7e-6);
  }
}

TEST(AveragedRecord, ReducesNoiseByTheRootOfTheSampleCount) {
  const double noise_mm = 0.05;
  const Record averaged = averaged_to(parabola(noise_mm), 0.025);
  EXPECT_NEAR(fast_noise_mm(averaged), noise_mm / 5, 0.2 * noise_mm / 5);
}

TEST(AveragedRecord, MeanIsMissingOnlyIfAllReadingsAreMissing) {
  Record record = parabola(0);
  const double none = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 96; i <= 104; ++i) record.reading_mm[i] = none;
  record.reading_mm[201] = none;
  const Record averaged = averaged_to(record, 0.010);
  EXPECT_FALSE(std::isfinite(averaged.reading_mm[10]))
      << "the mean must be missing if all nine readings are missing";
  EXPECT_TRUE(std::isfinite(averaged.reading_mm[9]));
  EXPECT_NEAR(averaged.reading_mm[20], 2 * 0.2 * 0.2, 2e-3)
      << "the mean must use the other readings if one of nine readings is missing";
  EXPECT_EQ(averaged.readings, 400U);
}

TEST(AveragedRecord, SparseRecordStaysUnchanged) {
  const Record record = parabola(0.05);
  EXPECT_EQ(averaged_to(record, 0.0015).reading_mm, record.reading_mm);
}

TEST(AveragedRecord, CampaignIsAveragedToTheRequestedCount) {
  const std::vector<Record> campaign{parabola(0), parabola(0)};  // each record has 4001 readings
  EXPECT_EQ(averaged_to_count(campaign, 8002, 1).front().size(), 4001U)
      << "the records have no more readings than requested, so no means are computed";
  const std::vector<Record> averaged = averaged_to_count(campaign, 800, 1);
  ASSERT_EQ(averaged.size(), 2U);
  for (const Record& record : averaged) EXPECT_EQ(record.size(), 364U) << "means over 11 samples";
  EXPECT_EQ(averaged_to_count(campaign, 800, 0.005).front().size(), 801U)
      << "a mean must not cover more than 5 ms";
}

TEST(StridedRecord, OnlyAveragingChangesTheFinestInterval) {
  EXPECT_EQ(thinned_to(parabola(0), 0.02).finest_interval_s, 1e-3);
  EXPECT_NEAR(averaged_to(parabola(0), 0.02).finest_interval_s, 0.02, 1e-12)
      << "a mean over a longer time would smooth a fast signal";
}

/// Returns a record of a ramp. The record lasts 4 s and is sampled at 1 kHz.
Record ramp() {
  Record record;
  for (int i = 0; i <= 4000; ++i) {
    record.time_s.push_back(1e-3 * i);
    record.duration_s.push_back(i == 0 ? 0 : 1e-3);
    record.drive_kpa.push_back(1e-2 * i);
    record.reading_mm.push_back(2e-3 * i);
    record.temperature_c.push_back(20 + 1e-3 * i);
  }
  record.sample_time_s = 1e-3;
  record.finest_interval_s = 1e-3;
  record.readings = record.size();
  return record;
}

TEST(CentredRecord, KeepsTheFirstSampleAndTheMiddleOfEveryInterval) {
  const Record thin = thinned_to_centres(ramp(), 0.011);
  ASSERT_GE(thin.size(), 364U);
  EXPECT_EQ(thin.time_s[0], 0);
  EXPECT_EQ(thin.sample_time_s, 0) << "the first time step differs from the other time steps";
  EXPECT_NEAR(thin.finest_interval_s, 0.011, 1e-4) << "each kept sample replaces all samples within 0.011 s";
  for (std::size_t i = 1; i + 1 < thin.size(); ++i) {
    EXPECT_NEAR(thin.time_s[i], 0.011 * (static_cast<double>(i) - 0.5), 0.51e-3);
    EXPECT_NEAR(thin.duration_s[i], thin.time_s[i] - thin.time_s[i - 1], 1e-9);
    EXPECT_NEAR(thin.drive_kpa[i], 10 * thin.time_s[i], 1e-9);
    EXPECT_NEAR(thin.reading_mm[i], 2 * thin.time_s[i], 1e-9);
    EXPECT_NEAR(thin.temperature_c[i], 20 + thin.time_s[i], 1e-9);
  }
  EXPECT_EQ(thin.duration_s[5], thin.duration_s[6]) << "equal time steps must use the same coefficients";
  EXPECT_TRUE(thin.supply_kpa.empty());
}

TEST(CentredRecord, CountsTheRemainingReadings) {
  Record record = ramp();
  for (std::size_t i = 1000; i < 3000; ++i) record.reading_mm[i] = std::numeric_limits<double>::quiet_NaN();
  const Record thin = thinned_to_centres(record, 0.02);
  EXPECT_NEAR(static_cast<double>(thin.readings), 0.5 * static_cast<double>(thin.size()), 2);
}

TEST(CentredRecord, CoarserRecordStaysUnchanged) {
  const Record same = thinned_to_centres(ramp(), 0.5e-3);
  EXPECT_EQ(same.time_s, ramp().time_s);
  EXPECT_EQ(same.sample_time_s, 1e-3);
}

Log three_samples() {
  Log log;
  log.name = "log";
  log.time_s = {0, 1, 3};
  log.pressure_command_kpa = {0, 10, 30};
  log.displacement_mm = {0, 1, 3};
  return log;
}

TEST(FinerRecord, InterpolatesTheDriveAndAddsNoReadings) {
  const Record record = make_records({three_samples()}, {}).front();
  const Record fine = finer_record(record, 2);
  ASSERT_EQ(fine.size(), 5U);
  EXPECT_EQ(fine.time_s, (std::vector<double>{0, 0.5, 1, 2, 3}));
  EXPECT_EQ(fine.duration_s, (std::vector<double>{0, 0.5, 0.5, 1, 1}));
  EXPECT_EQ(fine.drive_kpa, (std::vector<double>{0, 5, 10, 20, 30}));
  EXPECT_TRUE(std::isnan(fine.reading_mm[1]));
  EXPECT_EQ(fine.reading_mm[2], record.reading_mm[1]);
  EXPECT_EQ(finer_record(record, 1).time_s, record.time_s);
}

TEST(FinerRecord, HeldDriveIsNotInterpolated) {
  const Record fine = finer_record(make_records({three_samples()}, {.held = true}).front(), 2);
  EXPECT_EQ(fine.drive_kpa, (std::vector<double>{0, 0, 10, 10, 30}));
}

TEST(FewerReadings, KeepsEveryKthReadingAndAllSamples) {
  Record record = ramp();
  record.reading_mm[3] = std::numeric_limits<double>::quiet_NaN();
  --record.readings;
  const Record few = with_fewer_readings({record}, 1000).front();
  EXPECT_EQ(few.time_s, record.time_s);
  EXPECT_EQ(few.readings, 1000U);
  const auto left =
      std::count_if(few.reading_mm.begin(), few.reading_mm.end(), [](double y) { return std::isfinite(y); });
  EXPECT_EQ(left, 1000);
  EXPECT_EQ(few.reading_mm[0], record.reading_mm[0]);
  EXPECT_EQ(with_fewer_readings({record}, 4000).front().readings, 4000U) << "no sample must be omitted";
}

TEST(FirstSamples, ShortensAllRecordsByTheSameFactor) {
  Record longer = ramp(), shorter = ramp();
  shorter = first_samples({shorter}, shorter.size() / 4).front();
  EXPECT_EQ(shorter.size(), longer.size() / 4);
  shorter.reading_mm[1] = std::numeric_limits<double>::quiet_NaN();
  const std::size_t all = longer.size() + shorter.size();
  const auto first = first_samples({longer, shorter}, all / 5);
  ASSERT_EQ(first.size(), 2U);
  EXPECT_NEAR(static_cast<double>(first[0].size()), static_cast<double>(longer.size()) / 5, 1);
  EXPECT_NEAR(static_cast<double>(first[1].size()), static_cast<double>(shorter.size()) / 5, 1);
  EXPECT_EQ(first[1].readings, first[1].size() - 1);
  EXPECT_EQ(first[0].sample_time_s, longer.sample_time_s);
  EXPECT_TRUE(std::equal(first[0].drive_kpa.begin(), first[0].drive_kpa.end(), longer.drive_kpa.begin()));
  EXPECT_EQ(first[0].duration_s.size(), first[0].size());
  EXPECT_EQ(first_samples({longer}, longer.size()).front().size(), longer.size());
  EXPECT_EQ(first_samples({longer, shorter}, 0)[1].size(), 2U);
}

TEST(ThinnedLog, AllColumnsHaveTheSameSamples) {
  Log log;
  for (int i = 0; i < 8; ++i) {
    for (auto* column : {&log.time_s, &log.pressure_command_kpa, &log.displacement_mm, &log.temperature_c})
      column->push_back(i);
  }
  log.others = {{"remark", {"a", "b", "c", "d", "e", "f", "g", "h"}}};
  const Log thin = thinned_log(log, 3);
  const std::vector<double> kept{0, 3, 6};
  for (const auto* column :
       {&thin.time_s, &thin.pressure_command_kpa, &thin.displacement_mm, &thin.temperature_c})
    EXPECT_EQ(*column, kept);
  EXPECT_EQ(thin.others[0].cells, (std::vector<std::string>{"a", "d", "g"}));
  EXPECT_TRUE(thin.pressure_kpa.empty());
  EXPECT_EQ(thinned_log(log, 1).time_s, log.time_s);
}

}  // namespace
}  // namespace softgrip::sysid::resampled_record_test
