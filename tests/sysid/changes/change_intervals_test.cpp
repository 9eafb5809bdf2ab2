#include "sysid/changes/change_intervals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <string_view>

#include "base/statistics.h"
#include "sysid/changes/change_search.h"
#include "sysid/changes/later_readings.h"
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

/// Returns the width of an interval if a variance is added (Student's t; degrees of freedom from Welch).
/// @param alone  width without this variance.
double widened(double alone, double added, double freedom) {
  const double variance = std::pow(alone / (2 * 1.96), 2) + added;
  return 2 * std::sqrt(f_quantile(0.95, 1, freedom * std::pow(variance / added, 2)) * variance);
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
  // one, so half of the mean square is the variance between runs. It has one degree of freedom.
  constexpr double added = 0.001 / 2;
  EXPECT_NEAR(between, widened(alone, added, 1), 0.2 * between) << "a deviation is one linear step";
  const double equal = width(intervals_of(later, {delay}, {unit(0), unit(0), unit(0)})[0].size);
  EXPECT_GT(equal, alone) << "the healthy runs have noise";
  EXPECT_LT(equal, 0.2 * between) << "the healthy runs do not differ";
}

TEST_F(ChangeIntervals, WidenByTheUncertaintyOfTheBaselineModel) {
  const std::vector<Record> records = pressure_records(test::logs_of({.delay_s = 0.06}, 5, true), false);
  const std::vector<std::vector<double>> left = residuals_of(base_, records);
  const LaterReadings later = readings_of(base_, records, left);
  const FittedEffect delay = fitted(later, "transport_delay");
  std::vector<Base> bases;
  for (const double delay_s : {0.02, 0.0, 0.04}) {
    bases.push_back(fit_base(pressure_records(test::logs_of({.delay_s = delay_s}, 1, true), false),
                             Judged::pressure, Drive::command, {}));
  }
  const auto with = [&](const std::vector<Base>& models) {
    return width(intervals_of(later, {delay}, {}, left_out_readings(models, records, left))[0].size);
  };
  const double alone = width(intervals_of(later, {delay}, {})[0].size);
  // The sum of squares of the three delays about their mean is 0.0008 s^2. The factor of the jackknife is
  // 2/3.
  EXPECT_NEAR(with(bases), widened(alone, 0.0008 * 2 / 3, 2), 0.2 * with(bases));
  EXPECT_NEAR(with({base_, base_, base_}), alone, 1e-9) << "equal models have no uncertainty";
}

TEST_F(ChangeIntervals, LeftOutModelsAreThoseOfTheCrossValidation) {
  const std::vector<Base> without = left_out_bases(base_);
  ASSERT_EQ(without.size(), base_.units.count());
  for (std::size_t unit = 0; unit < without.size(); ++unit) {
    const LaterReadings own = healthy_readings(base_).only(base_.units, unit);
    const std::vector<Record> record{base_.records[unit]};
    const LaterReadings again = readings_of(without[unit], record, residuals_of(without[unit], record));
    EXPECT_NEAR(again.plain_rms({}), own.plain_rms({}), 0.05 * own.plain_rms({}));
    EXPECT_GT((without[unit].filter_weights - base_.filter_weights).norm(), 0);
  }
}

// The estimated delay of a run differs between runs, and a wrong delay of the baseline model appears in all
// later runs. The true change is known.
TEST_F(ChangeIntervals, CoverTheTrueChangeIfTheDelayDiffersBetweenRuns) {
  constexpr double change_s = 0.06, spread_s = 0.008;
  constexpr int draws = 15;
  constexpr std::size_t runs = 3;
  std::mt19937 random(4);
  std::normal_distribution<double> delay_s(0.04, spread_s);
  int held = 0, held_by_noise = 0;
  for (unsigned i = 0; i < draws; ++i) {
    std::vector<Log> healthy, later;
    for (unsigned r = 0; r < runs; ++r) {
      healthy.push_back(test::log_of({.delay_s = delay_s(random)}, 100 * i + 10 + r, true));
      later.push_back(test::log_of({.delay_s = change_s + delay_s(random)}, 100 * i + 50 + r, true));
    }
    const Base base = fit_base(pressure_records(healthy, false), Judged::pressure, Drive::command, {});
    const std::vector<Record> records = pressure_records(later, false);
    const std::vector<std::vector<double>> left = residuals_of(base, records);
    const LaterReadings readings = readings_of(base, records, left);
    const FittedEffect delay = fitted(readings, "transport_delay");
    std::vector<HealthyFits> units;
    for (std::size_t unit = 0; unit < base.units.count(); ++unit)
      units.push_back({healthy_readings(base).only(base.units, unit), {}});
    const std::vector<Base> without = left_out_bases(base);
    const auto covers = [&](const EffectIntervals& intervals) {
      return intervals.numbers[0] && intervals.numbers[0]->lower <= change_s &&
                     change_s <= intervals.numbers[0]->upper
                 ? 1
                 : 0;
    };
    held += covers(intervals_of(readings, {delay}, units, left_out_readings(without, records, left))[0]);
    held_by_noise += covers(intervals_of(readings, {delay}, {})[0]);
  }
  RecordProperty("held", held);
  EXPECT_GE(held, 12) << "of " << draws << "; with 95 % coverage, fewer in 1 of 1600 tests";
  EXPECT_LT(held_by_noise, held) << "the later runs alone do not show the error of the baseline model";
}

TEST_F(ChangeIntervals, WidenByTheDifferencesBetweenLaterRuns) {
  const auto later = [&](std::vector<double> delays_s) {
    std::vector<Log> logs;
    for (const double delay_s : delays_s)
      logs.push_back(test::log_of({.delay_s = delay_s}, 30 + static_cast<unsigned>(logs.size()), true));
    const std::vector<Record> records = pressure_records(logs, false);
    return readings_of(base_, records, residuals_of(base_, records));
  };
  const auto width_of = [&](const LaterReadings& readings) {
    return width(intervals_of(readings, {fitted(readings, "transport_delay")}, {})[0].size);
  };
  // The variance of the mean of the three delays is 0.0004 / 3 s^2, with two degrees of freedom.
  const double expected = 2 * t_quantile(2) * std::sqrt(0.0004 / 3);
  EXPECT_NEAR(width_of(later({0.06, 0.04, 0.08})), expected, 0.3 * expected);
  EXPECT_LT(width_of(later({0.06, 0.06, 0.06})), 0.3 * expected);
}

TEST_F(ChangeIntervals, StateWhatTheyContain) {
  const auto contains = [](const Base& base, std::size_t later_runs, std::string_view source) {
    const std::vector<std::string> all = contained_in_intervals(base, later_runs);
    return std::find(all.begin(), all.end(), source) != all.end();
  };
  EXPECT_TRUE(contains(base_, 3, "differences between the healthy logs"));
  EXPECT_TRUE(contains(base_, 3, "differences between the later logs"));
  EXPECT_FALSE(contains(base_, 2, "differences between the later logs"));
  Base single = base_;
  single.units = Units({base_.records.front()});
  EXPECT_FALSE(contains(single, 3, "differences between the healthy logs"));
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
