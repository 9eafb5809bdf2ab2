#include "sysid/changes/bins.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "tests/sysid/changes/finger.h"

namespace softgrip::sysid::bins_test {
namespace {

std::vector<Record> records() {
  return make_records(test::logs_of({}, 1), {});
}

TEST(Bins, AverageFiniteSamplesAndAreNanWithoutSamples) {
  const Record record = records().front();  // the record is sampled at 50 Hz
  std::vector<double> series(record.size(), 1.0);
  series[0] = 3;
  series[5] = series[6] = series[7] = series[8] = series[9] = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> bins = binned(record, series, 0.1);
  EXPECT_EQ(bins.size(), 400U);
  EXPECT_NEAR(bins[0], (3 + 4 * 1) / 5.0, 1e-12);
  EXPECT_TRUE(std::isnan(bins[1]));
  EXPECT_EQ(bins[2], 1);
}

TEST(Bins, SeriesIsPaddedWithTheLastValueOrTruncated) {
  EXPECT_EQ(with_bins({1, 2}, 4), (std::vector<double>{1, 2, 2, 2}));
  EXPECT_EQ(with_bins({1, 2, 3}, 2), (std::vector<double>{1, 2}));
}

constexpr double innovation = 0.5;

/// Returns two realisations of a first-order autoregressive process. The mean of the process is `zero`, and
/// the standard deviation of its innovations is `innovation`.
Binned autoregression(double weight, double zero, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, innovation);
  Binned residual(2, std::vector<double>(4000));
  for (auto& series : residual) {
    double last = 0;
    for (double& v : series) {
      last = weight * last + normal(random);
      v = last + zero;
    }
  }
  return residual;
}

TEST(Bins, WhitenerRemovesTheCorrelationOfAnAutoregression) {
  const Binned residual = autoregression(0.9, 0, 3), peak_rate(2, std::vector<double>(4000, 0.0));
  const Whitener whitener = whitener_of(residual, peak_rate, 3);
  EXPECT_NEAR(whitener.before[0], 0.9, 0.05);
  EXPECT_NEAR(whitener.spread_at(0), innovation, 0.02);
  const WhiteRows rows(residual, peak_rate, whitener);
  const Eigen::VectorXd white = rows(residual);
  const Eigen::Index n = white.size() - 1;
  EXPECT_NEAR(white.squaredNorm() / static_cast<double>(n), 1, 0.05);
  EXPECT_NEAR(white.head(n).dot(white.tail(n)) / static_cast<double>(n), 0, 0.05);
}

TEST(Bins, RunOffsetDoesNotIncreaseTheInnovationSpread) {
  const Binned peak_rate(2, std::vector<double>(4000, 0.0));
  EXPECT_NEAR(whitener_of(autoregression(0.5, 35, 5), peak_rate, 3).spread_at(0), innovation, 0.02);
}

TEST(Bins, SpreadIsEstimatedSeparatelyForHighInputRates) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal(0, 1);
  Binned residual(1, std::vector<double>(8000)), peak_rate(1, std::vector<double>(8000));
  for (std::size_t i = 0; i < 8000; ++i) {
    peak_rate[0][i] = static_cast<double>(i % 100);
    residual[0][i] = normal(random) * (peak_rate[0][i] > 90 ? 10 : 1);
  }
  const Whitener whitener = whitener_of(residual, peak_rate, 2);
  EXPECT_NEAR(whitener.spread_at(10), 1, 0.1);
  EXPECT_NEAR(whitener.spread_at(99), 10, 1);
}

TEST(Bins, RowsRequireFinitePrecedingBins) {
  Binned residual(1, std::vector<double>(20, 1.0));
  residual[0][10] = std::numeric_limits<double>::quiet_NaN();
  const Whitener whitener{{0.5, 0.1}, {}, {1}};
  const WhiteRows rows(residual, Binned(1, std::vector<double>(20, 0.0)), whitener);
  EXPECT_EQ(rows.rows().size(), (10U - 2) + (9U - 2));
}

}  // namespace
}  // namespace softgrip::sysid::bins_test
