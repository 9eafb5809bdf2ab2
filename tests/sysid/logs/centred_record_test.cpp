#include "sysid/logs/centred_record.h"

#include <gtest/gtest.h>

#include <limits>

namespace softgrip::sysid::centred_record_test {
namespace {

/// A ramp at 1 kHz, 4 s.
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
  EXPECT_EQ(thin.sample_time_s, 0) << "the first step is another one";
  EXPECT_NEAR(thin.finest_interval_s, 0.011, 1e-4) << "a sample stands for those around it";
  for (std::size_t i = 1; i + 1 < thin.size(); ++i) {
    EXPECT_NEAR(thin.time_s[i], 0.011 * (static_cast<double>(i) - 0.5), 0.51e-3);
    EXPECT_NEAR(thin.duration_s[i], thin.time_s[i] - thin.time_s[i - 1], 1e-9);
    EXPECT_NEAR(thin.drive_kpa[i], 10 * thin.time_s[i], 1e-9);
    EXPECT_NEAR(thin.reading_mm[i], 2 * thin.time_s[i], 1e-9);
    EXPECT_NEAR(thin.temperature_c[i], 20 + thin.time_s[i], 1e-9);
  }
  EXPECT_EQ(thin.duration_s[5], thin.duration_s[6]) << "equal steps share their coefficients";
  EXPECT_TRUE(thin.supply_kpa.empty());
}

TEST(CentredRecord, CountsTheReadingsThatAreLeft) {
  Record record = ramp();
  for (std::size_t i = 1000; i < 3000; ++i) record.reading_mm[i] = std::numeric_limits<double>::quiet_NaN();
  const Record thin = thinned_to_centres(record, 0.02);
  EXPECT_NEAR(static_cast<double>(thin.readings), 0.5 * static_cast<double>(thin.size()), 2);
}

TEST(CentredRecord, WhatIsCoarserAlreadyStaysAsItIs) {
  const Record same = thinned_to_centres(ramp(), 0.5e-3);
  EXPECT_EQ(same.time_s, ramp().time_s);
  EXPECT_EQ(same.sample_time_s, 1e-3);
}

}  // namespace
}  // namespace softgrip::sysid::centred_record_test
