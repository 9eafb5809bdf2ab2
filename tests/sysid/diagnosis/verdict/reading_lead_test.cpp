#include "sysid/diagnosis/verdict/reading_lead.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>

#include "model/blocks/clock_offset.h"
#include "model/blocks/kelvin_voigt.h"
#include "model/named.h"
#include "sysid/fitting/trajectory.h"
#include "tests/sysid/diagnosis/campaign.h"

namespace softgrip::sysid::reading_lead_test {
namespace {

TEST(WithDriveAhead, ShiftsTheDriveEarlierAndKeepsTheFirstSample) {
  const std::vector<Record> before = known_campaign(1);
  // The lead of 0.05 s is 2.5 samples long. Between two samples, the command is linear.
  const Record after = with_drive_ahead(before, 0.05).front();
  EXPECT_EQ(after.drive_kpa[0], before[0].drive_kpa[0]);
  EXPECT_TRUE(std::isnan(after.reading_mm[0]));
  EXPECT_NEAR(after.duration_s[1], before[0].duration_s[1] + 0.05, 1e-12);
  EXPECT_EQ(after.duration_s[2], before[0].duration_s[2]);
  for (std::size_t i = 1; i + 3 < after.size(); ++i)
    ASSERT_NEAR(after.drive_kpa[i], 0.5 * (before[0].drive_kpa[i + 2] + before[0].drive_kpa[i + 3]), 1e-9)
        << i;
}

TEST(WithDriveAhead, HidesTheLastReadingsWithoutAShiftedDrive) {
  const std::vector<Record> before = known_campaign(1);
  const Record after = with_drive_ahead(before, 0.1).front();
  const std::size_t last = after.size() - 1;
  EXPECT_TRUE(std::isfinite(after.reading_mm[last - 5]));
  for (std::size_t i = last - 4; i <= last; ++i) EXPECT_TRUE(std::isnan(after.reading_mm[i])) << i;
  EXPECT_EQ(after.readings, before[0].readings - 6) << "the reading of the first sample is hidden, too";
}

TEST(WithDriveAhead, HeldDriveIsShiftedWithoutInterpolation) {
  std::vector<Record> before = known_campaign(1);
  before[0].held = true;
  const Record after = with_drive_ahead(before, 0.05).front();
  for (std::size_t i = 1; i + 3 < after.size(); ++i)
    ASSERT_EQ(after.drive_kpa[i], before[0].drive_kpa[i + 2]) << i;
}

/// Returns a record of 60 s that begins at rest. It is sampled at 10 Hz and contains no readings yet.
Record smooth_record() {
  Log log;
  log.name = "smooth";
  for (int i = 0; i < 600; ++i) {
    const double t_s = 0.1 * i;
    log.time_s.push_back(t_s);
    log.pressure_command_kpa.push_back(25 - 20 * std::cos(0.9 * t_s) - 5 * std::cos(0.35 * t_s));
  }
  log.displacement_mm.assign(log.size(), 0);
  return make_records({log}, {})[0];
}

/// Returns autoregressive noise of order 1 with a standard deviation of 1.
std::vector<double> noise_of(double correlation, std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<double> values{normal(random)};
  while (values.size() < count)
    values.push_back(correlation * values.back() + std::sqrt(1 - correlation * correlation) * normal(random));
  return values;
}

// The tolerance is about three standard errors of the share of intervals that contain the true lead. The
// noise is so small that all estimates lie between the same two multiples of the sampling interval.
TEST(FitLead, TheIntervalContainsTheTrueLeadInAbout95PercentOfTheCases) {
  constexpr double true_lead_s = 0.55, noise_mm = 0.5;
  constexpr std::uint64_t cases = 200;
  const model::Model finger = model::with_block({}, {model::block_type<model::KelvinVoigt>(), {3}});
  const Record record = smooth_record();
  const std::vector<Record> ahead = with_drive_ahead({record}, true_lead_s);
  const std::vector<double> answer_mm = predict(finger, ahead[0], rest_starts(finger, ahead)[0]);
  Selection selection;
  selection.extended.point.model =
      model::with_block(finger, {model::block_type<model::ClockOffset>(), {0.35 * true_lead_s}});
  selection.left.excess_mm = HUGE_VAL;
  for (const double correlation : {0.0, 0.8}) {
    int found = 0, contained = 0;
    for (std::uint64_t seed = 1; seed <= cases; ++seed) {
      Record noisy = record;
      const std::vector<double> noise = noise_of(correlation, record.size(), seed);
      for (std::size_t i = 0; i < noisy.size(); ++i) noisy.reading_mm[i] = answer_mm[i] + noise_mm * noise[i];
      const SearchData data = make_search_data({noisy}, finger);
      selection.base.point = data.given;
      const auto fit = fit_lead(data, selection, noise_mm);
      if (!fit) continue;
      ++found;
      contained += excludes(fit->lead.ci95, true_lead_s) ? 0 : 1;
    }
    EXPECT_EQ(found, static_cast<int>(cases)) << correlation;
    EXPECT_NEAR(static_cast<double>(contained) / static_cast<double>(cases), 0.95, 0.05) << correlation;
  }
}

}  // namespace
}  // namespace softgrip::sysid::reading_lead_test
