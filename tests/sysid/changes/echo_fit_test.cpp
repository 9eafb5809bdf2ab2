#include "sysid/changes/echo_fit.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace softgrip::sysid::echo_fit_test {
namespace {

constexpr double bin_s = 0.1;

Record waving() {
  Record record;
  record.name = "waving";
  for (int i = 0; i < 1500; ++i) {
    const double t = 0.02 * i;
    record.time_s.push_back(t);
    record.duration_s.push_back(i > 0 ? 0.02 : 0);
    record.drive_kpa.push_back(12 - 10 * std::cos(t) * std::cos(0.3 * t));
  }
  record.sample_time_s = 0.02;
  record.largest_kpa = 22;
  return record;
}

/// What a model leaves: a share of the drive half a second ago, and something of its own.
Binned left_of(const Record& record, double share) {
  const std::vector<double> drive = binned(record, lagged(record, record.drive_kpa, 0.5), bin_s);
  Binned left{{}};
  for (std::size_t b = 0; b < drive.size(); ++b)
    left[0].push_back(share * drive[b] + 0.01 * std::sin(0.7 * static_cast<double>(b * b)));
  return left;
}

TEST(EchoFit, ExplainsWhatFollowsTheDrive) {
  const Record record = waving();
  const FittedEcho echo = fit_echo({record}, EchoKind::finger, bin_s, 22, {left_of(record, 0.1)})[0];
  EXPECT_LT(echo.left_mm, 0.02);
  EXPECT_GT(echo.left_mm, 0.005);
}

TEST(EchoFit, OfSeveralModelsIsThatOfEach) {
  const Record record = waving();
  std::vector<Binned> left{left_of(record, 0.1), left_of(record, -0.2), left_of(record, 0.3)};
  left[1][0][40] = std::numeric_limits<double>::quiet_NaN();
  const std::vector<FittedEcho> together = fit_echo({record}, EchoKind::finger, bin_s, 22, left);
  ASSERT_EQ(together.size(), 3U);
  for (std::size_t m = 0; m < 3; ++m) {
    const FittedEcho alone = fit_echo({record}, EchoKind::finger, bin_s, 22, {left[m]})[0];
    EXPECT_EQ(together[m].left_mm, alone.left_mm) << m;
    EXPECT_EQ(together[m].weights, alone.weights) << m;
    EXPECT_EQ(std::isnan(together[m].left[0][40]), m == 1) << m;
  }
}

}  // namespace
}  // namespace softgrip::sysid::echo_fit_test
