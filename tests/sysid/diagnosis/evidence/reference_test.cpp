#include "sysid/diagnosis/evidence/reference.h"

#include <gtest/gtest.h>

#include "tests/sysid/diagnosis/campaign.h"

namespace softgrip::sysid {
namespace {

constexpr double noise_mm = 0.03;

Reference reference_of(const std::vector<Record>& records, const ByRecord& residual) {
  ReferenceOptions options;
  options.threads = 1;
  options.most_samples = 3000;
  return smooth_reference(records, readings_of(records), residual, noise_mm, options);
}

TEST(Reference, NothingIsExplainedOfNoise) {
  const std::vector<Record> records = known_campaign(3);
  const Reference white = reference_of(records, noise_for(records, noise_mm, 0, 3));
  EXPECT_TRUE(!white.present || white.explained_percent.lower == 0);
}

TEST(Reference, CorrelatedErrorsThatNothingPredictsAreNotExplained) {
  const std::vector<Record> records = known_campaign(3);
  int alarms = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Reference reference = reference_of(records, noise_for(records, 0.2, 0.98, seed));
    ASSERT_TRUE(reference.present);
    EXPECT_LT(reference.explained_percent.value, 15) << seed;
    alarms += reference.explained_percent.lower > 0 ? 1 : 0;
  }
  EXPECT_LE(alarms, 1);
}

TEST(Reference, AHistoryThatBendsIsExplainedAndNamed) {
  // A power of what the pressure was on average over the last three seconds: no column has it.
  const std::vector<Record> records = known_campaign(3);
  ByRecord residual = noise_for(records, noise_mm, 0, 5);
  double average = 0;
  for (std::size_t k = 0; k < records.size(); ++k) {
    for (std::size_t i = 0; i < residual[k].size(); ++i) {
      average += (records[k].drive_kpa[i] - average) * 0.02 / 3;
      residual[k][i] += 0.002 * average * average;
    }
  }
  const Reference reference = reference_of(records, residual);
  ASSERT_TRUE(reference.present);
  EXPECT_GT(reference.explained_percent.value, 90);
  EXPECT_LE(reference.explained_percent.lower, reference.explained_percent.value);
  EXPECT_EQ(reference.groups.front().id, "slow_pressure");
  EXPECT_LT(reference.rmse_after_mm, 0.35 * reference.rmse_before_mm);
}

}  // namespace
}  // namespace softgrip::sysid
