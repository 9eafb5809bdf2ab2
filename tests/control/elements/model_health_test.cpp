#include "control/elements/model_health.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace softgrip::control::model_health_test {
namespace {

constexpr double tick_s = 0.005;

// Returns settings with short intervals, so that the tests need few ticks.
ModelHealthSettings short_intervals() {
  ModelHealthSettings settings;
  settings.model_error_mm = 0.2;
  settings.correlation_time_s = 1;
  settings.interval_s = 0.5;
  settings.unfit_mm = 3;
  return settings;
}

// Generates random residuals with the noise and the correlation that the settings describe as healthy.
class HealthyResidual {
 public:
  HealthyResidual(const ModelHealthSettings& settings, unsigned seed)
      : random_(seed),
        keep_(std::exp(-tick_s / settings.correlation_time_s)),
        drive_mm_(settings.model_error_mm * std::sqrt(1 - keep_ * keep_)),
        noise_mm_(settings.noise_mm),
        slow_mm_(settings.model_error_mm * normal_(random_)) {}
  double next() {
    slow_mm_ = keep_ * slow_mm_ + drive_mm_ * normal_(random_);
    return slow_mm_ + noise_mm_ * normal_(random_);
  }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  double keep_, drive_mm_, noise_mm_, slow_mm_;
};

// Simulates a two-sided CUSUM of independent standard normal values. Returns the average run length until an
// alarm.
double simulated_run_length(double allowance, double threshold, int runs, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  double total = 0;
  for (int run = 0; run < runs; ++run) {
    double up = 0, down = 0;
    while (std::max(up, down) < threshold) {
      const double z = normal(random);
      up = std::max(0.0, up + z - allowance);
      down = std::max(0.0, down - z - allowance);
      ++total;
    }
  }
  return total / runs;
}

TEST(ModelHealth, RunLengthFormulaAgreesWithTheTablesAndWithSimulation) {
  // Source: Montgomery, Introduction to Statistical Quality Control. With the allowance 0.5, CUSUM charts
  // with the thresholds 4 and 5 have average run lengths of 168 and 465.
  EXPECT_NEAR(cusum_run_length(0.5, 4), 168, 0.02 * 168);
  EXPECT_NEAR(cusum_run_length(0.5, 5), 465, 0.02 * 465);
  const unsigned seed = 11;
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937_64 random(seed);
  for (const double threshold : {3.0, 5.0, 6.0}) {
    const double stated = cusum_run_length(0.5, threshold);
    // The run length has a nearly geometric distribution, so the mean of 2000 runs has a standard error of
    // 2.2 %.
    EXPECT_NEAR(simulated_run_length(0.5, threshold, 2000, random), stated, 0.08 * stated);
  }
}

TEST(ModelHealth, ThresholdIsTheInverseOfTheRunLength) {
  for (const double length : {50.0, 1e3, 1e6, 7.2e6}) {
    EXPECT_NEAR(cusum_run_length(0.5, cusum_threshold(0.5, length)) / length, 1, 1e-9);
  }
}

TEST(ModelHealth, WhitenerGivesIndependentStandardNormalInnovations) {
  for (const double correlation_s : {0.2, 1.0, 5.0}) {
    ModelHealthSettings settings = short_intervals();
    settings.correlation_time_s = correlation_s;
    HealthyResidual residual(settings, 3);
    ResidualWhitener whitener(settings);
    std::vector<double> z;
    for (int i = 0; i < 20000; ++i) {
      double sum = 0;
      for (int k = 0; k < 100; ++k) sum += residual.next();
      z.push_back(whitener.next(sum / 100, 100));
    }
    double mean = 0, square = 0;
    for (const double value : z) mean += value / 20000, square += value * value / 20000;
    EXPECT_NEAR(mean, 0, 0.06) << correlation_s;
    EXPECT_NEAR(square, 1, 0.04) << correlation_s;
    for (const std::size_t lag : {1U, 2U, 5U}) {
      double product = 0;
      for (std::size_t i = lag; i < z.size(); ++i) product += z[i] * z[i - lag] / 20000;
      EXPECT_NEAR(product, 0, 0.03) << "lag " << lag << ", correlation time " << correlation_s;
    }
  }
}

// Although successive residuals are correlated, the mean time between false alarms must equal the time in the
// settings within 10 %.
TEST(ModelHealth, FalseAlarmsComeAtTheStatedRate) {
  ModelHealthSettings settings = short_intervals();
  settings.false_alarm_interval_s = 100;  // 200 intervals of interval_s: short enough that the test can
                                          // count many false alarms
  settings.unfit_mm = 1e9;
  double seconds = 0;
  constexpr int runs = 1000;
  for (unsigned seed = 1; seed <= runs; ++seed) {
    HealthyResidual residual(settings, seed);
    ModelHealth health(settings, tick_s);
    while (health.state() != HealthState::suspect) {
      health.observe(residual.next());
      seconds += tick_s;
    }
  }
  // The times between alarms have a nearly exponential distribution, so the mean of 1000 times has a standard
  // error of 3.2 %.
  EXPECT_NEAR(seconds / runs, settings.false_alarm_interval_s, 0.1 * settings.false_alarm_interval_s)
      << "seeds 1 to " << runs;
}

// Without whitening of the residual, the same threshold must cause many more false alarms.
TEST(ModelHealth, ACusumWithoutWhiteningAlarmsMoreOften) {
  ModelHealthSettings settings = short_intervals();
  settings.correlation_time_s = 5;
  const double threshold = cusum_threshold(0.5, 2000);
  double intervals = 0;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    HealthyResidual residual(settings, seed);
    double up = 0, down = 0;
    while (std::max(up, down) < threshold) {
      double sum = 0;
      for (int k = 0; k < 100; ++k) sum += residual.next();
      const double z = sum / 100 / settings.model_error_mm;
      up = std::max(0.0, up + z - 0.5);
      down = std::max(0.0, down - z - 0.5);
      ++intervals;
    }
  }
  EXPECT_LT(intervals / 100, 200)
      << "without a change, the stated false-alarm rate would give a mean of 2000 intervals between alarms";
}

TEST(ModelHealth, DetectsAResidualShiftAndRecovers) {
  const ModelHealthSettings settings = short_intervals();  // these settings have an average time between
                                                           // false alarms of 1000 h
  HealthyResidual residual(settings, 5);
  ModelHealth health(settings, tick_s);
  for (int i = 0; i < 12000; ++i) health.observe(residual.next());
  EXPECT_EQ(health.state(), HealthState::healthy);
  int ticks = 0;
  while (health.state() == HealthState::healthy && ticks < 100000) {
    health.observe(residual.next() + 1.0);
    ++ticks;
  }
  EXPECT_EQ(health.state(), HealthState::suspect);
  EXPECT_LT(ticks * tick_s, 60);
  // The state must become healthy when the model fits the finger again.
  for (int i = 0; i < 40000; ++i) health.observe(residual.next());
  EXPECT_EQ(health.state(), HealthState::healthy);
}

TEST(ModelHealth, ALargeResidualChangesTheStateToUnfitOnce) {
  const ModelHealthSettings settings = short_intervals();
  ModelHealth health(settings, tick_s);
  int changes = 0;
  for (int i = 0; i < 2000; ++i) changes += health.observe(4) ? 1 : 0;
  EXPECT_EQ(health.state(), HealthState::unfit);
  EXPECT_EQ(changes, 1);
  EXPECT_NEAR(health.rms_mm(), 4, 1e-9);
  for (int i = 0; i < 1000; ++i) health.observe(2.5);
  EXPECT_EQ(health.state(), HealthState::unfit)
      << "the model becomes healthy again only if the residual falls below 0.7 times unfit_mm";
  for (int i = 0; i < 40000; ++i) health.observe(0);
  EXPECT_EQ(health.state(), HealthState::healthy);
}

TEST(ModelHealth, IntervalsWithTooFewReadingsAreNotEvaluated) {
  const ModelHealthSettings settings = short_intervals();
  ModelHealth health(settings, tick_s);
  for (int i = 0; i < 10000; ++i) health.skip();
  EXPECT_EQ(health.state(), HealthState::unknown);
  // An interval is evaluated only if at least half of its ticks have a reading. In this test, a quarter of
  // the ticks have a reading.
  for (int i = 0; i < 10000; ++i) i % 4 == 0 ? health.observe(50) : health.skip();
  EXPECT_EQ(health.state(), HealthState::unknown);
}

}  // namespace
}  // namespace softgrip::control::model_health_test
