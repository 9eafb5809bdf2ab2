#include "sysid/health/control_chart.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace softgrip::sysid::health::control_chart_test {
namespace {

constexpr double least = 1e-9;
const std::string recipe = "pick";

class Healthy {
 public:
  Healthy(unsigned seed, double mean, double spread) : random_(seed), mean_(mean), spread_(spread) {}
  double operator()() { return mean_ + spread_ * normal_(random_); }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  double mean_, spread_;
};

// Source of the two-sided quantiles of Student's t: Abramowitz and Stegun, table 26.10. The quantiles for p =
// 0.05 and p = 0.001 correspond to the normal values 1.960 and 3.291.
TEST(ControlChart, WallaceFormulaConvertsStudentTToNormal) {
  EXPECT_NEAR(normal_of_t(2.776, 4), 1.960, 0.02);
  EXPECT_NEAR(normal_of_t(2.228, 10), 1.960, 0.01);
  EXPECT_NEAR(normal_of_t(4.587, 10), 3.291, 0.02);
  EXPECT_NEAR(normal_of_t(-3.646, 30), -3.291, 0.01);
  EXPECT_EQ(normal_of_t(0, 5), 0);
  // With one degree of freedom, the normal value of the approximation may be too small, but it must not be
  // too large.
  EXPECT_LT(normal_of_t(12.706, 1), 1.960);
  EXPECT_LT(normal_of_t(636.6, 1), 3.291);
}

TEST(ControlChart, HealthyValuesAreStandardisedAndUncorrelated) {
  Healthy healthy(3, 40, 7);
  double sum = 0, squares = 0, products = 0, beyond_two = 0;
  constexpr int runs = 4000, length = 30;
  int count = 0;
  for (int run = 0; run < runs; ++run) {
    RunningReference reference;
    double before = 0;
    for (int i = 0; i < length; ++i) {
      const double value = healthy();
      if (const auto z = reference.judge(value, least); z && i >= 4) {
        sum += *z;
        squares += *z * *z;
        products += *z * before;
        beyond_two += std::abs(*z) > 2 ? 1 : 0;
        before = *z;
        ++count;
      }
      reference.learn(value);
    }
  }
  EXPECT_NEAR(sum / count, 0, 0.012);
  EXPECT_NEAR(squares / count, 1, 0.015);
  EXPECT_NEAR(products / count, 0, 0.012);
  EXPECT_NEAR(beyond_two / count, 0.0455, 0.0025);
}

int length_of_run(Healthy& healthy, const ChartLimits& limits) {
  ControlChart chart(limits, least);
  int length = 0;
  while (!chart.alarm()) {
    chart.add({{recipe, healthy()}});
    ++length;
  }
  return length;
}

TEST(ControlChart, InControlRunLengthMatchesTheStatedValue) {
  Healthy healthy(5, -2, 0.03);
  for (const double stated : {100.0, 400.0}) {
    const ChartLimits limits = ChartLimits::for_run_length(stated);
    double total = 0;
    constexpr int runs = 1500;
    for (int run = 0; run < runs; ++run) total += length_of_run(healthy, limits);
    // The run lengths are nearly geometric, so their mean has a standard error of 2.6 %. The rest of the
    // tolerance covers two effects: the approximations by Siegmund and Wallace, and the small correlation
    // that the chart estimates for independent values.
    EXPECT_NEAR(total / runs / stated, 1.1, 0.17) << "stated run length " << stated;
  }
}

// A chart with few points may have at most 1.6 times the stated alarm rate.
TEST(ControlChart, NewChartsHaveASimilarFalseAlarmRate) {
  Healthy healthy(23, 0, 1);
  const ChartLimits limits = ChartLimits::for_run_length(20000);
  int alarms = 0;
  constexpr int charts = 20000, youth = 60;
  for (int c = 0; c < charts; ++c) {
    ControlChart chart(limits, least);
    for (int i = 0; i < youth && !chart.alarm(); ++i) chart.add({{recipe, healthy()}});
    alarms += chart.alarm() ? 1 : 0;
  }
  EXPECT_LT(alarms / (static_cast<double>(charts) * youth / 20000), 1.6);
}

/// A first-order autoregressive process with standard deviation 1. `persistence` is the correlation between
/// successive values.
class Weather {
 public:
  Weather(unsigned seed, double persistence) : random_(seed), persistence_(persistence) {
    now_ = normal_(random_);
  }
  double operator()() {
    now_ = persistence_ * now_ + std::sqrt(1 - persistence_ * persistence_) * normal_(random_);
    return now_;
  }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  double persistence_, now_ = 0;
};

TEST(ControlChart, PersistenceEstimatesTheAutocorrelation) {
  for (const double persistence : {0.0, 0.5, 0.8}) {
    Weather weather(29, persistence);
    RunningReference reference;
    for (int i = 0; i < 4000; ++i) reference.learn(300 + 0.01 * weather());
    EXPECT_NEAR(reference.persistence(), persistence, 0.04);
  }
}

// Effects of the weather last for days. If the chart treated successive days as independent, two thirds of
// the charts would raise a false alarm.
TEST(ControlChart, AutocorrelatedValuesSeldomRaiseAnAlarm) {
  const ChartLimits limits = ChartLimits::for_run_length(30000);
  int alarms = 0;
  constexpr int charts = 1000;
  for (unsigned seed = 0; seed < charts; ++seed) {
    Weather weather(1000 + seed, 0.7);
    ControlChart chart(limits, least);
    for (int i = 0; i < 90 && !chart.alarm(); ++i) chart.add({{recipe, weather()}});
    alarms += chart.alarm() ? 1 : 0;
  }
  EXPECT_LT(alarms, 0.2 * charts);
}

TEST(ControlChart, FewerFalseAlarmsNeedWiderLimits) {
  const ChartLimits often = ChartLimits::for_run_length(100), seldom = ChartLimits::for_run_length(30000);
  EXPECT_GT(seldom.cusum, often.cusum + 3);
  EXPECT_GT(seldom.single, often.single + 1);
  EXPECT_NEAR(std::erfc(seldom.single / std::sqrt(2.0)) * 60000, 1, 1e-6);
}

/// Shifts the values by `spreads` standard deviations. Returns the number of points from the shift to the
/// alarm, as the median over many simulated charts.
int noticed_after(double spreads, int healthy_points) {
  std::vector<int> delays;
  for (unsigned seed = 0; seed < 101; ++seed) {
    Healthy healthy(100 + seed, 5, 0.2);
    ControlChart chart(ChartLimits::for_run_length(30000), least);
    for (int i = 0; i < healthy_points; ++i) chart.add({{recipe, healthy()}});
    if (chart.alarm()) continue;
    int delay = 0;
    while (!chart.alarm() && delay < 1000) {
      chart.add({{recipe, healthy() + spreads * 0.2}});
      ++delay;
    }
    delays.push_back(delay);
  }
  std::nth_element(delays.begin(), delays.begin() + 50, delays.end());
  return delays[50];
}

TEST(ControlChart, LargeChangesAlarmEarlierThanSmallOnes) {
  EXPECT_EQ(noticed_after(10, 20), 1);
  EXPECT_LE(noticed_after(4, 20), 7);
  EXPECT_LE(noticed_after(2, 40), 15);
  EXPECT_GT(noticed_after(2, 40), noticed_after(4, 40));
}

/// The chart must not add points of a possible change to its reference. The reference has only 8 healthy
/// values, so the changed values would soon dominate it.
TEST(ControlChart, ChangeSoonAfterTheStartIsDetected) {
  int noticed = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    Healthy healthy(500 + seed, 5, 0.2);
    ControlChart chart(ChartLimits::for_run_length(30000), least);
    for (int i = 0; i < 8; ++i) chart.add({{recipe, healthy()}});
    for (int i = 0; i < 30; ++i) chart.add({{recipe, healthy() + 1.2}});
    noticed += chart.alarm() ? 1 : 0;
  }
  EXPECT_GE(noticed, 94);
}

TEST(ControlChart, AlarmStatesTheStartAndSizeOfTheChange) {
  Healthy healthy(7, 5, 0.2);
  ControlChart chart(ChartLimits::for_run_length(30000), least);
  std::vector<double> values;
  while (!chart.alarm()) {
    values.push_back(healthy() - (values.size() < 40 ? 0 : 0.6));
    chart.add({{recipe, values.back()}});
  }
  const std::size_t since = chart.alarm()->since;
  EXPECT_NEAR(static_cast<double>(since), 40, 2);
  EXPECT_GT(chart.alarm()->noticed, since);
  for (int i = 0; i < 50; ++i) chart.add({{recipe, healthy() - 0.6}});
  EXPECT_NEAR(chart.alarm()->change, -0.6, 0.1);
  // The reference must exclude all points after the beginning of the change.
  double usual = 0;
  for (std::size_t i = 0; i < since; ++i) usual += values[i] / static_cast<double>(since);
  EXPECT_NEAR(chart.references().at(recipe).mean(), usual, 1e-12);
}

TEST(ControlChart, CusumDatesAGradualChangeBeforeTheAlarm) {
  Healthy healthy(31, 5, 0.2);
  ControlChart chart(ChartLimits::for_run_length(30000), least);
  for (int i = 0; i < 60; ++i) chart.add({{recipe, healthy()}});
  for (int day = 1; day < 30 && !chart.alarm(); ++day) chart.add({{recipe, healthy() - 0.25 * day}});
  ASSERT_TRUE(chart.alarm());
  EXPECT_LT(chart.alarm()->since, chart.alarm()->noticed);
  EXPECT_NEAR(static_cast<double>(chart.alarm()->since), 61, 2);
}

TEST(ControlChart, AcceptsAnExternalAlarmWithAnEarlierStart) {
  Healthy healthy(37, 5, 0.2);
  ControlChart chart(ChartLimits::for_run_length(30000), least);
  for (int i = 0; i < 40; ++i) chart.add({{recipe, healthy()}});
  for (int i = 0; i < 4; ++i) chart.add({{recipe, healthy() + 0.3}});
  ASSERT_FALSE(chart.alarm());
  chart.take_alarm(0);
  chart.take_alarm(44);
  EXPECT_FALSE(chart.alarm());
  chart.take_alarm(42);
  EXPECT_EQ(chart.alarm()->since, 42U);
  chart.take_alarm(43);  // no effect, because the alarm began before point 43
  EXPECT_EQ(chart.alarm()->since, 42U);
  chart.take_alarm(40);
  ASSERT_TRUE(chart.alarm());
  EXPECT_EQ(chart.alarm()->since, 40U);
  EXPECT_EQ(chart.alarm()->noticed, 43U);
  EXPECT_EQ(chart.references().at(recipe).count(), 40U);
  for (int i = 0; i < 50; ++i) chart.add({{recipe, healthy() + 0.3}});
  EXPECT_NEAR(chart.alarm()->change, 0.3, 0.08);
  EXPECT_EQ(chart.references().at(recipe).count(), 40U);
}

TEST(ControlChart, AlarmIsIndependentOfUnitAndZero) {
  std::vector<double> values;
  Healthy healthy(11, 0, 1);
  for (int i = 0; i < 60; ++i) values.push_back(healthy() + (i > 40 ? 3 : 0));
  ControlChart one(ChartLimits::for_run_length(1000), least), other(ChartLimits::for_run_length(1000), least);
  for (const double value : values) {
    const auto z = one.add({{recipe, value}});
    const auto same = other.add({{recipe, 273 + 0.001 * value}});
    ASSERT_EQ(z.has_value(), same.has_value());
    if (z) {
      EXPECT_NEAR(*z, *same, 1e-6);
    }
  }
  ASSERT_TRUE(one.alarm() && other.alarm());
  EXPECT_EQ(one.alarm()->noticed, other.alarm()->noticed);
}

TEST(ControlChart, RecipesHaveSeparateReferences) {
  Healthy healthy(13, 0, 0.05);
  ControlChart chart(ChartLimits::for_run_length(30000), least);
  for (int i = 0; i < 200; ++i) {
    const double far = i % 3 == 0 ? 20 : 0;
    chart.add({{far > 0 ? "hand_over" : recipe, far + healthy()}});
  }
  EXPECT_FALSE(chart.alarm());
  // The values of a new recipe differ greatly from the values of all other recipes. The new recipe must get a
  // reference of its own.
  for (int i = 0; i < 10; ++i) chart.add({{"new", 7 + healthy()}});
  EXPECT_FALSE(chart.alarm());
}

TEST(ControlChart, CorrelatedRecipesDoNotRaiseTheAlarmRate) {
  const ChartLimits limits = ChartLimits::for_run_length(200);
  double total = 0;
  Healthy healthy(17, 0, 1);
  constexpr int runs = 600;
  for (int run = 0; run < runs; ++run) {
    ControlChart chart(limits, least);
    while (!chart.alarm()) {
      const double value = healthy();
      chart.add({{"a", value}, {"b", 5 + value}, {"c", 2 * value}});
      total += 1;
    }
  }
  EXPECT_GT(total / runs, 0.9 * 200);
}

TEST(ControlChart, NegligibleDifferencesRaiseNoAlarm) {
  ControlChart chart(ChartLimits::for_run_length(1000), 0.01);
  for (int i = 0; i < 20; ++i) chart.add({{recipe, 1.0}});
  for (int i = 0; i < 5; ++i) chart.add({{recipe, 1.004}});
  EXPECT_FALSE(chart.alarm());
  for (int i = 0; i < 5; ++i) chart.add({{recipe, 1.3}});
  EXPECT_TRUE(chart.alarm());
}

}  // namespace
}  // namespace softgrip::sysid::health::control_chart_test
