#include "sysid/changes/change_intervals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/statistics.h"
#include "sysid/changes/change_search.h"
#include "tests/sysid/changes/pressure_base.h"

namespace softgrip::sysid::change_intervals_test {
namespace {

class ChangeIntervals : public test::PressureBase {
 protected:
  FittedEffect fitted(const LaterReadings& readings, std::string_view id,
                      const std::vector<FittedEffect>& others = {}) {
    for (const Effect& effect : effects_for(base_, readings.records(), {}, true)) {
      if (effect.id == id) return fit_effect(readings, effect, others, readings.white(others)).fitted;
    }
    ADD_FAILURE() << "no effect " << id;
    return {};
  }
};

double width(const std::optional<Interval>& interval) {
  return interval ? interval->upper - interval->lower : 0;
}

// Compares the width of the intervals with the scatter of the estimates. Each estimate comes from a different
// input signal with different noise.
TEST_F(ChangeIntervals, CoverTheTrueDelayAndMatchTheEstimateScatter) {
  constexpr double delay_s = 0.06;
  constexpr int draws = 30;
  double sum = 0, squares = 0, widths = 0;
  int held = 0;
  for (int i = 0; i < draws; ++i) {
    const LaterReadings later = readings({.delay_s = delay_s}, 20 + 2 * static_cast<unsigned>(i));
    const FittedEffect delay = fitted(later, "transport_delay");
    const EffectIntervals intervals = intervals_of(later, {delay}, {}).front();
    ASSERT_TRUE(intervals.numbers.at(0));
    held += intervals.numbers[0]->lower <= delay_s && delay_s <= intervals.numbers[0]->upper ? 1 : 0;
    sum += delay.numbers[0];
    squares += delay.numbers[0] * delay.numbers[0];
    widths += width(intervals.numbers[0]) / draws;
  }
  const double scatter = std::sqrt((squares - sum * sum / draws) / (draws - 1));
  RecordProperty("held", held);
  EXPECT_GE(held, 25) << "number of intervals that contain the true delay, of "
                      << draws;  // 25 of 30: with 95 % coverage, fewer than 25 intervals contain the true
                                 // delay in 1 of 300 tests
  EXPECT_GT(widths, 0.6 * 2 * 1.96 * scatter);
  EXPECT_LT(widths, 2.5 * 2 * 1.96 * scatter);
}

TEST_F(ChangeIntervals, WidenByTheVariationBetweenHealthyRuns) {
  const LaterReadings later = readings({.delay_s = 0.06}, 5);
  const FittedEffect delay = fitted(later, "transport_delay");
  // The size of a delay is the delay. Its interval, unlike the interval of the parameter, has no limits.
  const auto unit = [&](double delay_s) { return HealthyFits{readings({.delay_s = delay_s}, 9), {}}; };
  const double alone = width(intervals_of(later, {delay}, {})[0].size);
  const double between = width(intervals_of(later, {delay}, {unit(0.02), unit(0.04)})[0].size);
  // The mean square of the two healthy delays is 0.001 s^2. Each of the two units is predicted from the other
  // one, so half of the mean square is the variance between runs.
  const auto later_runs = static_cast<double>(later.records().size());
  const double added = 0.001 / 2 * (1 / later_runs + 0.5);
  const double variance = std::pow(alone / (2 * 1.96), 2) + added;
  const double quantile = std::sqrt(f_quantile(0.95, 1, 3 * std::pow(variance / added, 2)));
  EXPECT_NEAR(between, 2 * quantile * std::sqrt(variance), 0.2 * between) << "a deviation is one linear step";
  const double equal = width(intervals_of(later, {delay}, {unit(0), unit(0), unit(0)})[0].size);
  EXPECT_GT(equal, alone) << "the healthy runs have noise";
  EXPECT_LT(equal, 0.2 * between) << "the healthy runs do not differ";
}

TEST_F(ChangeIntervals, DeviationsOfEitherSignWidenTheInterval) {
  const LaterReadings later = readings({.delay_s = 0.06}, 5);
  const FittedEffect delay = fitted(later, "transport_delay");
  const Base early = fit_base(pressure_records(test::logs_of({.delay_s = 0.04}, 1, true), false),
                              Judged::pressure, Drive::command, {});
  const std::vector<Record> records = pressure_records(test::logs_of({}, 9, true), false);
  const LaterReadings sooner = readings_of(early, records, residuals_of(early, records));
  const auto with = [&](const LaterReadings& unit) {
    return width(intervals_of(later, {delay}, {{unit, {}}, {unit, {}}})[0].size);
  };
  EXPECT_NEAR(with(sooner), with(readings({.delay_s = 0.04}, 9)), 0.2 * with(sooner))
      << "a pressure that is 0.04 s earlier counts as much as one that is 0.04 s later";
}

TEST_F(ChangeIntervals, SizeIntervalEqualsTheParameterInterval) {
  const LaterReadings later = readings({.delay_s = 0.06}, 5);
  const EffectIntervals intervals = intervals_of(later, {fitted(later, "transport_delay")}, {}).front();
  ASSERT_TRUE(intervals.size && intervals.numbers.at(0));
  EXPECT_NEAR(intervals.size->lower, intervals.numbers[0]->lower, 1e-6);
  EXPECT_NEAR(intervals.size->upper, intervals.numbers[0]->upper, 1e-6);
}

TEST_F(ChangeIntervals, WidenWithASimilarSecondEffect) {
  const LaterReadings later = readings({.delay_s = 0.06, .valve_lag_s = 0.05}, 5);
  const FittedEffect delay = fitted(later, "transport_delay");
  const FittedEffect lag = fitted(later, "valve_lag", {delay});
  const auto together = intervals_of(later, {delay, lag}, {});
  ASSERT_EQ(together.size(), 2U);
  EXPECT_GT(width(together[0].numbers.at(0)), 1.3 * width(intervals_of(later, {delay}, {})[0].numbers.at(0)));
  EXPECT_GT(width(together[1].numbers.at(0)), 0);
}

TEST_F(ChangeIntervals, AreAbsentForAParameterWithoutInfluence) {
  const LaterReadings later = readings({}, 5);
  FittedEffect stop = fitted(later, "pressure_saturation");
  stop.numbers.at(0) = stop.effect.numbers[0].upper;  // the pressure limit is far above the commanded
                                                      // pressures, so it has no effect
  const EffectIntervals intervals = intervals_of(later, {stop}, {}).front();
  EXPECT_FALSE(intervals.numbers.at(0));
  EXPECT_FALSE(intervals.size);
}

}  // namespace
}  // namespace softgrip::sysid::change_intervals_test
