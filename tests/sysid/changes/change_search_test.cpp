#include "sysid/changes/change_search.h"

#include <gtest/gtest.h>

#include "sysid/changes/change_size.h"
#include "tests/sysid/changes/finger.h"

namespace softgrip::sysid {
namespace {

/// A base that is its echo alone: quick to fit.
class ChangeSearch : public ::testing::Test {
 protected:
  ChangeSearch()
      : base_(fit_base(pressure_records(test::logs_of({}, 1, true), false), Judged::pressure, Drive::command,
                       {})) {}

  LaterReadings readings(const test::Finger& finger) {
    const std::vector<Record> records = pressure_records(test::logs_of(finger, 5, true), false);
    return readings_of(base_, records, residuals_of(base_, records));
  }

  Base base_;
};

TEST_F(ChangeSearch, ADelayTakesMostOfWhatADelayLeaves) {
  const LaterReadings later = readings({.delay_s = 0.06});
  const std::vector<Effect> effects = effects_for(base_, later.records(), {}, true);
  const std::vector<ScoredEffect> ranked = ranked_effects(later, effects, {}, {}, 1);
  ASSERT_FALSE(ranked.empty());
  EXPECT_EQ(ranked.front().fit.fitted.effect.id, "transport_delay");
  const ChangeSize size = size_of(later, ranked.front().fit.fitted, 0);
  EXPECT_EQ(size.unit, "s");
  EXPECT_NEAR(size.value, 0.06, 0.01);
  const std::vector<double> with = block_sums(later, ranked.front().fit.white);
  const std::vector<double> without = block_sums(later, later.white({}));
  EXPECT_EQ(with.size(), without.size());
  EXPECT_GT(resampled(without, with, 1).lower, 0);
}

TEST_F(ChangeSearch, WhatACauseGainsByChanceCountsAgainstIt) {
  const LaterReadings later = readings({.delay_s = 0.06});
  const std::vector<Effect> effects = effects_for(base_, later.records(), {}, true);
  const std::vector<ScoredEffect> ranked = ranked_effects(later, effects, {}, {{"transport_delay", 1e9}}, 1);
  EXPECT_EQ(ranked.back().fit.fitted.effect.id, "transport_delay");
}

TEST_F(ChangeSearch, WhatIsAddedAtFullPressureIsItsMean) {
  const LaterReadings later = readings({});
  Binned added = later.left();
  for (auto& series : added) std::fill(series.begin(), series.end(), -0.7);
  EXPECT_NEAR(at_full_pressure(later, added), -0.7, 1e-9);
}

TEST(Resampled, EqualSumsAreNoDifference) {
  const Resampled same = resampled({1, 2, 3}, {1, 2, 3}, 1);
  EXPECT_EQ(same.share, 0);
  EXPECT_EQ(same.lower, 0);
  EXPECT_EQ(same.upper, 0);
}

}  // namespace
}  // namespace softgrip::sysid
