#include "sysid/changes/change_intervals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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
  const auto unit = [&](double delay_s, double gain) {
    ScoredEffect scored;
    scored.gain = gain;
    scored.fit.fitted = delay;
    scored.fit.fitted.numbers = {delay_s};
    return HealthyFits{readings({}, 9), {scored}};
  };
  const double alone = width(intervals_of(later, {delay}, {})[0].numbers.at(0));
  const double between = width(intervals_of(later, {delay}, {unit(0.01, 1), unit(0.02, 1)})[0].numbers.at(0));
  // The delays of the two healthy runs are 0.01 s and 0.02 s. Their mean square is 0.00025 s^2. The variance
  // of the difference between one run and the mean of two runs is 1.5 times this mean square.
  const double expected = 2 * 1.96 * std::sqrt(0.00025 * 1.5);
  EXPECT_NEAR(between, std::hypot(alone, expected), 1e-3 * between);
  // In this healthy run, the delay does not reduce the error. The run then gives no information about the
  // variation of the delay between runs. The interval must therefore have the width that the later readings
  // alone lead to.
  EXPECT_DOUBLE_EQ(width(intervals_of(later, {delay}, {unit(0.04, -0.1)})[0].numbers.at(0)), alone);
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
