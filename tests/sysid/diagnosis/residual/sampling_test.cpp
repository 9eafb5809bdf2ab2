#include "sysid/diagnosis/residual/sampling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "tests/sysid/diagnosis/campaign.h"

namespace softgrip::sysid::sampling_test {
namespace {

constexpr double noise_mm = 0.04;

std::vector<Record> noisy_campaign() {
  std::vector<Record> records = known_campaign(2);
  const ByRecord noise = noise_for(records, noise_mm, 0, 3);
  for (std::size_t k = 0; k < records.size(); ++k) {
    for (std::size_t i = 0; i < records[k].size(); ++i) records[k].reading_mm[i] += noise[k][i];
  }
  return records;
}

/// Replaces the reading of sample i by the reading of sample `sample(i)`, for each i.
std::vector<Record> read_at(std::vector<Record> records,
                            const std::function<std::size_t(std::size_t)>& sample) {
  for (Record& record : records) {
    const std::vector<double> truth = record.reading_mm;
    for (std::size_t i = 0; i < record.size(); ++i) record.reading_mm[i] = truth[sample(i)];
  }
  return records;
}

std::size_t readings_in(const std::vector<Record>& records) {
  std::size_t count = 0;
  for (const Record& record : records) {
    for (const double y : record.reading_mm) count += std::isfinite(y) ? 1U : 0U;
  }
  return count;
}

TEST(HideRepeated, KeepsReadingsWithoutRepetition) {
  const std::vector<Record> before = noisy_campaign();
  std::vector<Record> after = before;
  const SamplingEvidence evidence = hide_repeated(after);
  EXPECT_FALSE(evidence.present);
  EXPECT_EQ(readings_of(after), readings_of(before));
}

TEST(HideRepeated, KeepsTheFirstOfEachSlowReading) {
  const std::vector<Record> truth = noisy_campaign();
  std::vector<Record> records = read_at(truth, [](std::size_t i) { return i - i % 8; });
  const SamplingEvidence evidence = hide_repeated(records);
  ASSERT_TRUE(evidence.present);
  EXPECT_NEAR(evidence.interval_s, 8 * 0.02, 0.001);
  EXPECT_EQ(evidence.frozen_s, 0);
  EXPECT_EQ(readings_in(records), 2U * 3000 / 8);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < records[0].size(); ++i) {
    if (!std::isfinite(records[0].reading_mm[i])) continue;
    EXPECT_EQ(records[0].reading_mm[i], truth[0].reading_mm[i]);
    ++kept;
  }
  EXPECT_EQ(kept, 3000U / 8);
  EXPECT_EQ(records[0].readings, kept);
}

TEST(HideRepeated, EstimatesTheIntervalOfAnUnsynchronisedSensor) {
  // The sensor and the log have independent clocks. The sensor gives a new reading every 11.7 samples of the
  // log on average, that is, after 11 to 13 samples.
  std::vector<Record> records = read_at(noisy_campaign(), [](std::size_t i) {
    return static_cast<std::size_t>(std::floor(std::floor(static_cast<double>(i) / 11.7) * 11.7));
  });
  const SamplingEvidence evidence = hide_repeated(records);
  ASSERT_TRUE(evidence.present);
  EXPECT_NEAR(evidence.interval_s, 11.7 * 0.02, 0.02);
}

TEST(HideRepeated, HidesAFrozenSensor) {
  std::vector<Record> records =
      read_at(noisy_campaign(), [](std::size_t i) { return i >= 1010 && i < 1250 ? std::size_t{1010} : i; });
  const SamplingEvidence evidence = hide_repeated(records);
  ASSERT_TRUE(evidence.present);
  EXPECT_EQ(evidence.interval_s, 0);
  EXPECT_NEAR(evidence.frozen_s, 2 * 239 * 0.02, 0.1);
  for (const Record& record : records) {
    EXPECT_TRUE(std::isfinite(record.reading_mm[1010]));
    EXPECT_TRUE(std::isnan(record.reading_mm[1011]));
    EXPECT_TRUE(std::isnan(record.reading_mm[1249]));
    EXPECT_TRUE(std::isfinite(record.reading_mm[1250]));
  }
}

TEST(HideRepeated, HidesAFreezeAtAConstantDriveOnlyBesideAFreezeInMotion) {
  const auto frozen_campaign = [](bool also_in_motion) {
    std::vector<Record> records = read_at(noisy_campaign(), [&](std::size_t i) {
      if (i >= 2000 && i < 2240) return std::size_t{2000};
      return also_in_motion && i >= 1010 && i < 1250 ? std::size_t{1010} : i;
    });
    for (Record& record : records) std::fill_n(record.drive_kpa.begin() + 2000, 240, record.drive_kpa[2000]);
    return records;
  };
  std::vector<Record> at_constant_drive = frozen_campaign(false), both = frozen_campaign(true);
  EXPECT_FALSE(hide_repeated(at_constant_drive).present);
  const SamplingEvidence evidence = hide_repeated(both);
  ASSERT_TRUE(evidence.present);
  EXPECT_NEAR(evidence.frozen_s, 4 * 239 * 0.02, 0.1);
}

TEST(HideRepeated, LeavesASaturatedSensor) {
  std::vector<Record> records = noisy_campaign();
  for (Record& record : records) {
    for (double& y : record.reading_mm) y = std::min(y, 7.0);
  }
  const std::vector<Record> before = records;
  EXPECT_FALSE(hide_repeated(records).present);
  EXPECT_EQ(readings_of(records), readings_of(before));
}

TEST(HideRepeated, LeavesACoarseSensorAndAFingerThatSticks) {
  std::vector<Record> coarse = noisy_campaign();
  for (Record& record : coarse) {
    double stuck_mm = 0;
    for (double& y : record.reading_mm) {
      // The sensor has a resolution of 0.5 mm, and the displacement of the finger changes in steps of 1.5 mm.
      if (std::abs(y - stuck_mm) > 1.5) stuck_mm = y;
      y = 0.5 * std::round(stuck_mm / 0.5);
    }
  }
  const std::vector<Record> before = coarse;
  EXPECT_FALSE(hide_repeated(coarse).present);
  EXPECT_EQ(readings_of(coarse), readings_of(before));
}

TEST(HideRepeated, AcceptsRecordsWithoutReadings) {
  std::vector<Record> records = noisy_campaign();
  for (Record& record : records) {
    for (double& y : record.reading_mm) y = std::numeric_limits<double>::quiet_NaN();
    record.readings = 0;
  }
  EXPECT_FALSE(hide_repeated(records).present);
}

}  // namespace
}  // namespace softgrip::sysid::sampling_test
