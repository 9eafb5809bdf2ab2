#include "sysid/logs/strided_record.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace softgrip::sysid::strided_record_test {
namespace {

/// A parabola in time at 1 kHz, 4 s, with noise.
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

/// A command at 100 Hz, without readings.
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

/// The integral of the command [kPa s].
double integral_kpa_s(const Record& record) {
  double sum = 0;
  for (std::size_t i = 1; i < record.size(); ++i) {
    const double mean_kpa = (record.drive_kpa[i - 1] + record.drive_kpa[i]) / 2;
    sum += record.duration_s[i] * (record.held ? record.drive_kpa[i - 1] : mean_kpa);
  }
  return sum;
}

TEST(StridedRecord, AStepComesNeitherEarlyNorLateWhereverItIs) {
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
        EXPECT_GE(thin.drive_kpa[i], 0) << "beyond what was commanded a finger's memory would keep it";
        EXPECT_LE(thin.drive_kpa[i], 80);
      }
    }
  }
}

TEST(StridedRecord, ACornerStaysSharp) {
  std::vector<double> drive_kpa;
  for (int i = 0; i <= 40; ++i) drive_kpa.push_back(50 - 0.5 * std::abs(i - 20));
  const Record thin = thinned_record(commanded(drive_kpa), 2);
  for (std::size_t i = 0; i < thin.size(); ++i) EXPECT_DOUBLE_EQ(thin.drive_kpa[i], drive_kpa[2 * i]);
}

TEST(StridedRecord, BeginsWhereTheRecordBegins) {
  std::vector<double> drive_kpa(9, 60);
  drive_kpa[0] = 0;
  EXPECT_EQ(thinned_record(commanded(drive_kpa), 2).drive_kpa[0], 0);
}

TEST(AveragedRecord, KeepsTheMotionAndItsTimes) {
  const Record averaged = averaged_to(parabola(0), 0.010);
  ASSERT_EQ(averaged.size(), 401U);
  EXPECT_EQ(averaged.readings, 401U);
  EXPECT_DOUBLE_EQ(averaged.sample_time_s, 0.010);
  for (std::size_t i = 0; i < averaged.size(); ++i) {
    const double t_s = averaged.time_s[i];
    EXPECT_NEAR(t_s, 0.010 * static_cast<double>(i), 1e-12);
    EXPECT_NEAR(averaged.drive_kpa[i], 10 * t_s, 1e-9);
    // Nine readings, 1 ms apart: what a parabola gains by them is its curvature times their mean square.
    EXPECT_NEAR(averaged.reading_mm[i], 2 * t_s * t_s, 2 * 6.7e-6);
  }
}

TEST(AveragedRecord, HasLessNoiseByTheRootOfTheNumber) {
  const double noise_mm = 0.05;
  const Record averaged = averaged_to(parabola(noise_mm), 0.025);
  EXPECT_NEAR(fast_noise_mm(averaged), noise_mm / 5, 0.2 * noise_mm / 5);
}

TEST(AveragedRecord, ReadingsThatAreNotThereAreNotInvented) {
  Record record = parabola(0);
  const double none = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 96; i <= 104; ++i) record.reading_mm[i] = none;
  record.reading_mm[201] = none;
  const Record averaged = averaged_to(record, 0.010);
  EXPECT_FALSE(std::isfinite(averaged.reading_mm[10])) << "none of its nine is there";
  EXPECT_TRUE(std::isfinite(averaged.reading_mm[9]));
  EXPECT_NEAR(averaged.reading_mm[20], 2 * 0.2 * 0.2, 2e-3) << "one of nine is missing";
  EXPECT_EQ(averaged.readings, 400U);
}

TEST(AveragedRecord, ThatIsSparseEnoughStaysAsItIs) {
  const Record record = parabola(0.05);
  EXPECT_EQ(averaged_to(record, 0.0015).reading_mm, record.reading_mm);
}

TEST(StridedRecord, LeavesOutReadingsButTellsMotionsApartLikeTheLog) {
  EXPECT_EQ(thinned_to(parabola(0), 0.02).finest_interval_s, 1e-3);
  EXPECT_NEAR(averaged_to(parabola(0), 0.02).finest_interval_s, 0.02, 1e-12) << "a mean blurs what is faster";
}

}  // namespace
}  // namespace softgrip::sysid::strided_record_test
