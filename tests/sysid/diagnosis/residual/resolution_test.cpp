#include "sysid/diagnosis/residual/resolution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sysid/diagnosis/residual/noise.h"
#include "tests/sysid/diagnosis/campaign.h"

namespace softgrip::sysid::resolution_test {
namespace {

/// Returns two records with noise whose readings are rounded to multiples of `step_mm`; 0: not rounded.
std::vector<Record> rounded_campaign(double noise_mm, double step_mm, std::uint64_t seed = 11) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<Record> records = known_campaign(2);
  for (Record& record : records) {
    for (std::size_t i = 0; i < record.size(); ++i) {
      // A slow motion is added to the rests, so that the readings do not stay in the middle of a step.
      double& y = record.reading_mm[i];
      y += 1.5 * std::sin(0.07 * record.time_s[i]) + noise_mm * normal(random);
      if (step_mm > 0) y = step_mm * std::round(y / step_mm);
    }
  }
  return records;
}

TEST(CoarseStep, IsTheStepToWhichTheReadingsAreRounded) {
  for (const double step_mm : {0.13, 0.2, 0.5, 1.0})
    EXPECT_NEAR(coarse_step_mm(rounded_campaign(0.03, step_mm)), step_mm, 1e-9) << step_mm;
}

TEST(CoarseStep, ToleratesTheDecimalPlacesOfAFile) {
  std::vector<Record> records = rounded_campaign(0.01, 0.0489);
  for (Record& record : records) {
    for (double& y : record.reading_mm) y = 0.001 * std::round(y / 0.001);
  }
  EXPECT_NEAR(coarse_step_mm(records), 0.0489, 0.002);
}

TEST(CoarseStep, IsZeroIfTheNoiseIsLargerOrTheStepIsFine) {
  EXPECT_EQ(coarse_step_mm(rounded_campaign(0.03, 0)), 0) << "no rounding";
  EXPECT_EQ(coarse_step_mm(rounded_campaign(0.2, 0.2)), 0) << "the noise is larger than the step";
  EXPECT_EQ(coarse_step_mm(rounded_campaign(0, 0.001)), 0) << "a file with three decimal places";
  EXPECT_EQ(coarse_step_mm({}), 0);
}

/// The independent reference is the noise with which the readings were made.
TEST(NoiseBeforeRounding, IsRecoveredFromRoundedReadings) {
  for (const double noise_mm : {0.02, 0.05, 0.1}) {
    const std::vector<Record> records = rounded_campaign(noise_mm, 0.4);
    EXPECT_NEAR(noise_before_rounding_mm(records, 0.4, white_noise_mm(records)), noise_mm,
                0.2 * noise_mm + 0.01)
        << noise_mm;
  }
}

TEST(MeasuredNoise, ContainsTheErrorByRoundingOfACoarseSensor) {
  constexpr double noise_mm = 0.03, step_mm = 0.5;
  std::vector<Record> records = rounded_campaign(noise_mm, step_mm);
  for (Record& record : records) record.step_mm = step_mm;
  EXPECT_NEAR(measured_noise_mm(records), std::hypot(noise_mm, step_mm / std::sqrt(12)), 0.01);
}

/// Returns the residual of the rounded readings beside a prediction that is wrong by `error_mm` during motion
/// in one direction.
UnexplainedError error_beside(double step_mm, double error_mm) {
  const std::vector<Record> truth = rounded_campaign(0, 0), records = rounded_campaign(0.03, step_mm);
  std::vector<Record> coarse = records;
  for (Record& record : coarse) record.step_mm = step_mm;
  std::vector<std::vector<double>> residual_mm;
  for (std::size_t k = 0; k < records.size(); ++k) {
    residual_mm.emplace_back();
    for (std::size_t i = 0; i < records[k].size(); ++i) {
      const bool rises = i > 0 && truth[k].reading_mm[i] > truth[k].reading_mm[i - 1];
      residual_mm.back().push_back(records[k].reading_mm[i] - truth[k].reading_mm[i] -
                                   (rises ? error_mm : 0));
    }
  }
  return unexplained_error_of(residual_mm, measured_noise_mm(coarse), step_mm);
}

TEST(UnexplainedError, DoesNotContainTheErrorByRounding) {
  for (const double step_mm : {0.2, 0.5, 1.0}) {
    const UnexplainedError none = error_beside(step_mm, 0);
    EXPECT_FALSE(none.present) << step_mm << ": " << none.excess_mm << ", " << none.slow_correlation;
    const UnexplainedError wrong = error_beside(step_mm, 0.6 * step_mm);
    EXPECT_TRUE(wrong.present) << step_mm;
    EXPECT_GT(wrong.excess_mm, 0.2 * step_mm) << step_mm;
  }
}

}  // namespace
}  // namespace softgrip::sysid::resolution_test
