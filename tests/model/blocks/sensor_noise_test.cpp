#include "model/blocks/sensor_noise.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/model/drive.h"

namespace softgrip::model::testing::sensor_noise_test {
namespace {

using Block = SensorNoise<double>;

std::vector<double> readings(std::vector<double> values, std::uint64_t seed, int count, double dt) {
  Block block(values, Preparation{0, seed});
  std::vector<double> out;
  for (int i = 0; i < count; ++i) out.push_back(block.sample(0.0, dt, {}));
  return out;
}

double correlation(const std::vector<double>& x, std::size_t lag) {
  double sum = 0, square = 0;
  for (std::size_t i = 0; i + lag < x.size(); ++i) sum += x[i] * x[i + lag];
  for (const double v : x) square += v * v;
  return sum / square;
}

double rms(const std::vector<double>& x) {
  double sum = 0;
  for (const double v : x) sum += v * v;
  return std::sqrt(sum / static_cast<double>(x.size()));
}

// For 100,000 samples, the standard errors are 0.003 for a correlation, and 0.003 for the mean and 0.0022 for
// the RMS relative to the RMS of the noise.
TEST(SensorNoise, IsWhiteWithTheGivenRms) {
  const std::vector<double> x = readings({0.05, 0.0}, 7, 100000, 0.001);
  double mean = 0, fourth = 0;
  for (const double v : x) {
    mean += v / 100000;
    fourth += std::pow(v / 0.05, 4) / 100000;
  }
  EXPECT_NEAR(mean / 0.05, 0, 0.013);
  EXPECT_NEAR(rms(x) / 0.05, 1, 0.009);
  EXPECT_NEAR(fourth, 3, 0.13);
  for (std::size_t lag = 1; lag < 20; ++lag) EXPECT_NEAR(correlation(x, lag), 0, 0.013) << lag;
}

TEST(SensorNoise, IsCorrelatedOverTheGivenTime) {
  const std::vector<double> x = readings({0.05, 0.02}, 7, 100000, 0.005);
  EXPECT_NEAR(rms(x) / 0.05, 1, 0.03);
  EXPECT_NEAR(correlation(x, 1), std::exp(-0.25), 0.02);
  EXPECT_NEAR(correlation(x, 4), std::exp(-1.0), 0.03);
}

TEST(SensorNoise, OnlyEqualSeedsGiveEqualNoise) {
  EXPECT_EQ(readings({0.05, 0.1}, 3, 100, 0.01), readings({0.05, 0.1}, 3, 100, 0.01));
  const auto a = readings({0.05, 0.0}, 3, 10000, 0.01);
  const auto b = readings({0.05, 0.0}, 4, 10000, 0.01);
  double product = 0;
  for (std::size_t i = 0; i < a.size(); ++i) product += a[i] * b[i];
  EXPECT_NEAR(product / 10000 / (0.05 * 0.05), 0, 0.04);
}

TEST(SensorNoise, FirstRandomNumbersAreUnchanged) {
  // The test fails if the output of the random generator changes, because simulated recordings would then
  // differ from earlier ones.
  const auto x = readings({1.0, 0.0}, 1, 3, 0.01);
  EXPECT_NEAR(x[0], normal_at(1, 0), 0);
  EXPECT_NEAR(uniform_at(1, 0), 0.03401170130434644, 1e-16);
  EXPECT_NEAR(uniform_at(1, 1), 0.9140224628703029, 1e-16);
}

TEST(SensorNoise, AStepWithoutDurationDrawsNoRandomNumber) {
  Block block = make<Block>({0.05, 0.0});
  const double first = block.sample(0.0, 0.01, {});
  EXPECT_EQ(block.sample(3.0, 0.0, {}), 3.0 + first);
  EXPECT_NE(block.sample(0.0, 0.01, {}), first);
}

}  // namespace
}  // namespace softgrip::model::testing::sensor_noise_test
