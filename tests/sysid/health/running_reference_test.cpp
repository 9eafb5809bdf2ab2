#include "sysid/health/running_reference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace softgrip::sysid::health::running_reference_test {
namespace {

constexpr double least = 1e-9;

/// Generates values that change by 0.1 per °C and scatter around this line with a standard deviation of 0.05.
class Warm {
 public:
  explicit Warm(unsigned seed) : random_(seed) {}
  double at(double temperature_c) { return 30 + 0.1 * (temperature_c - 20) + 0.05 * normal_(random_); }
  double temperature_c() { return 20 + 2 * normal_(random_); }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

RunningReference learnt(Warm& warm, int values) {
  RunningReference reference;
  for (int i = 0; i < values; ++i) {
    const double temperature_c = warm.temperature_c();
    reference.learn(warm.at(temperature_c), temperature_c);
  }
  return reference;
}

TEST(RunningReference, EstimatesTheTemperatureSlope) {
  Warm warm(3);
  const RunningReference reference = learnt(warm, 60);
  ASSERT_TRUE(reference.slope());
  EXPECT_NEAR(reference.slope()->per_c, 0.1, 3 * reference.slope()->standard_error);
  EXPECT_NEAR(reference.slope()->standard_error, 0.05 / 2 / std::sqrt(60.0), 0.002);
  EXPECT_NEAR(reference.spread(), 0.05, 0.015);
  EXPECT_NEAR(reference.expected(25), 30.5, 0.05);
  EXPECT_NEAR(reference.expected(), reference.mean(), 1e-12);
  EXPECT_LT(reference.slope()->lowest_c, 18);
  EXPECT_GT(reference.slope()->highest_c, 22);
}

// Source: Brown, Durbin and Evans. A recursive residual is the deviation of a value from the regression line
// through all earlier values. For healthy values, these residuals are independent and have Student's t
// distribution.
TEST(RunningReference, RecursiveResidualsAreStandardNormal) {
  double sum = 0, squares = 0, products = 0, count = 0;
  for (unsigned seed = 0; seed < 1500; ++seed) {
    Warm warm(100 + seed);
    RunningReference reference = learnt(warm, 12);
    double before = 0;
    for (int i = 0; i < 20; ++i) {
      // The temperatures of this test stay within the range of the reference. Outside this range, the
      // reference would add an uncertainty.
      const double temperature_c = 20 + std::sin(i);
      const double value = warm.at(temperature_c);
      if (reference.slope()) {
        const double z = reference.judge(value, least, temperature_c).value_or(NAN);
        sum += z;
        squares += z * z;
        products += z * before;
        before = z;
        count += 1;
      }
      reference.learn(value, temperature_c);
    }
  }
  EXPECT_GT(count, 25000);
  EXPECT_NEAR(sum / count, 0, 0.03);
  EXPECT_NEAR(squares / count, 1, 0.05);
  EXPECT_NEAR(products / count, 0, 0.03);
}

TEST(RunningReference, InsignificantTemperatureSlopeIsOmitted) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  int found = 0;
  for (int run = 0; run < 1000; ++run) {
    RunningReference reference;
    for (int i = 0; i < 30; ++i) reference.learn(30 + 0.05 * normal(random), 20 + 2 * normal(random));
    found += reference.slope() ? 1 : 0;
  }
  EXPECT_LE(found, 12);  // at the stated rate, 2.7 of 1000 references are expected to have a slope
}

TEST(RunningReference, NarrowTemperatureRangeGivesNoSlope) {
  RunningReference reference;
  for (int i = 0; i < 40; ++i) {
    const double temperature_c = 20 + 0.1 * (i % 3);
    reference.learn(30 + 0.1 * temperature_c, temperature_c);
  }
  EXPECT_FALSE(reference.slope());
}

TEST(RunningReference, ExtrapolationAddsHalfTheTrendAsUncertainty) {
  Warm warm(11);
  const RunningReference reference = learnt(warm, 200);
  ASSERT_TRUE(reference.slope());
  const double far_c = reference.slope()->highest_c + 10;
  const double beyond = 10 * reference.slope()->per_c;
  const double z = reference.judge(reference.expected(far_c) + beyond, least, far_c).value_or(0);
  EXPECT_NEAR(z, 2, 0.05);
  // At 20 °C, which is within the range of the reference, the same deviation exceeds 10 standard deviations.
  EXPECT_GT(reference.judge(reference.expected(20) + beyond, least, 20).value_or(0), 10);
}

TEST(RunningReference, ValueWithoutTemperatureIsComparedWithTheMean) {
  Warm warm(13);
  const RunningReference reference = learnt(warm, 50);
  const double spread = 0.2;  // standard deviation of the values: 2 °C times 0.1 per °C
  const double z = reference.judge(reference.mean() + 3 * spread, least).value_or(0);
  EXPECT_NEAR(z, 3, 0.6);
}

TEST(RunningReference, PersistenceExcludesTheTemperatureEffect) {
  std::mt19937_64 random(17);
  std::normal_distribution<double> normal;
  RunningReference reference;
  double weather = 0;
  for (int i = 0; i < 3000; ++i) {
    weather = 0.8 * weather + 0.6 * normal(random);
    reference.learn(300 + 0.1 * weather + 0.05 * normal(random), 20 + weather);
  }
  ASSERT_TRUE(reference.slope());
  EXPECT_NEAR(reference.persistence(), 0, 0.03);
}

}  // namespace
}  // namespace softgrip::sysid::health::running_reference_test
