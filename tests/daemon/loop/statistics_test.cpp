#include "daemon/loop/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <thread>

namespace softgrip::daemon::statistics_test {
namespace {

TEST(Histogram, IsEmptyAtFirst) {
  const Histogram histogram;
  EXPECT_EQ(histogram.summary().count, 0U);
  EXPECT_EQ(histogram.quantile_ns(0.5), 0);
  EXPECT_TRUE(histogram.bins().empty());
}

TEST(Histogram, CountsNegativeAsZeroAndHugeValuesInTheLastBin) {
  Histogram histogram;
  histogram.add(-5);
  histogram.add(INT64_MAX / 2);
  EXPECT_EQ(histogram.bins().front().lower_ns, 0);
  EXPECT_EQ(histogram.bins().size(), 2U);
  EXPECT_EQ(histogram.summary().max_ns, INT64_MAX / 2);
  EXPECT_EQ(histogram.quantile_ns(1), INT64_MAX / 2);
}

TEST(Histogram, EachValueFallsIntoTheBinThatContainsIt) {
  // The lower limit of the bin must not exceed the duration. It may be below the duration by less than 0.8 %
  // of the duration plus 1 ns.
  for (std::int64_t duration = 1; duration < (std::int64_t{1} << 35); duration += 1 + duration / 97) {
    Histogram histogram;
    histogram.add(duration);
    const auto bins = histogram.bins();
    ASSERT_EQ(bins.size(), 1U);
    ASSERT_LE(bins.front().lower_ns, duration);
    ASSERT_LT(static_cast<double>(duration - bins.front().lower_ns),
              0.008 * static_cast<double>(duration) + 1);
  }
}

TEST(Histogram, QuantilesAgreeWithASort) {
  const unsigned seed = 7;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  std::lognormal_distribution<double> durations(9, 1.5);
  Histogram histogram;
  std::vector<std::int64_t> all;
  double sum = 0;
  for (int i = 0; i < 20'000; ++i) {
    all.push_back(std::llround(durations(random)));
    sum += static_cast<double>(all.back());
    histogram.add(all.back());
  }
  std::sort(all.begin(), all.end());
  const auto summary = histogram.summary();
  EXPECT_EQ(summary.count, all.size());
  EXPECT_EQ(summary.min_ns, all.front());
  EXPECT_EQ(summary.max_ns, all.back());
  EXPECT_NEAR(summary.mean_ns, sum / static_cast<double>(all.size()), 1e-6 * summary.mean_ns);
  for (const double q : {0.01, 0.5, 0.9, 0.99, 0.999}) {
    const auto rank = static_cast<std::size_t>(std::ceil(q * static_cast<double>(all.size()))) - 1;
    const auto exact = static_cast<double>(all[rank]);
    EXPECT_NEAR(static_cast<double>(histogram.quantile_ns(q)), exact, 0.008 * exact + 1) << q;
  }
}

TEST(Histogram, PrintsAsCyclictestDoes) {
  Histogram histogram;
  for (int i = 0; i < 3; ++i) histogram.add(12'345);
  histogram.add(14'000);
  EXPECT_EQ(histogram.cyclictest_text("wake-up latency, us"),
            "# Histogram (wake-up latency, us)\n000012 000003\n000013 000001\n# Total: 000000004\n"
            "# Min Latencies: 00012\n# Avg Latencies: 00013\n# Max Latencies: 00014\n");
}

TEST(Histogram, CanBeReadWhileItRecords) {
  Histogram histogram;
  std::thread recorder([&histogram] {
    for (int i = 0; i < 200'000; ++i) histogram.add(i % 1000);
  });
  for (int i = 0; i < 20; ++i) EXPECT_LE(histogram.summary().max_ns, 999);
  recorder.join();
  EXPECT_EQ(histogram.summary().count, 200'000U);
}

}  // namespace
}  // namespace softgrip::daemon::statistics_test
