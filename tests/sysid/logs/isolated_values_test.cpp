#include "sysid/logs/isolated_values.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace softgrip::sysid::isolated_values_test {
namespace {

constexpr double noise = 0.1;

/// Returns 500 values of a slow sine with a jump from 20 to 40 and noise.
std::vector<double> column() {
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0, noise);
  std::vector<double> values;
  for (int i = 0; i < 500; ++i) values.push_back((i < 250 ? 20 : 40) + std::sin(0.05 * i) + normal(random));
  return values;
}

TEST(IsolatedValues, AreNotFoundInNoiseAndAtAJump) {
  EXPECT_TRUE(isolated_values(column(), noise).empty());
}

TEST(IsolatedValues, AreFoundWithTheirDistance) {
  std::vector<double> values = column();
  values[100] += 5;
  values[300] -= 3;
  const std::vector<IsolatedValue> found = isolated_values(values, noise);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].sample, 100U);
  EXPECT_NEAR(found[0].distance, 5, 5 * noise);
  EXPECT_EQ(found[1].sample, 300U);
  EXPECT_NEAR(found[1].distance, -3, 5 * noise);
}

TEST(IsolatedValues, SamplesWithoutAValueAreSkipped) {
  std::vector<double> values = column();
  values[100] += 5;
  std::vector<double> sparse;
  for (const double value : values) {
    sparse.push_back(value);
    sparse.push_back(std::numeric_limits<double>::quiet_NaN());
  }
  const std::vector<IsolatedValue> found = isolated_values(sparse, noise);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].sample, 200U);
}

TEST(UsualSpan, IsIndependentOfSingleWrongValues) {
  std::vector<double> values = column();
  const double span = usual_span(values);
  EXPECT_NEAR(span, 22, 1);
  values[7] = 9999;
  EXPECT_NEAR(usual_span(values), span, noise);
  EXPECT_EQ(usual_span({}), 0);
}

TEST(ListedValues, AreAtMostThreeAndTheNumberOfTheOtherOnes) {
  const std::vector<double> values{500, 1, 0, 2.5, 7}, time_s{0, 0.02, 0.04, 0.06, 0.08};
  EXPECT_EQ(listed(values, time_s, {0}, "kPa"), "500 kPa at 0 s");
  EXPECT_EQ(listed(values, time_s, {0, 2, 3}, "mm"), "500 mm at 0 s, 0 mm at 0.04 s, 2.5 mm at 0.06 s");
  EXPECT_EQ(listed(values, time_s, {0, 1, 2, 3, 4}, "kPa"),
            "500 kPa at 0 s, 1 kPa at 0.02 s, 0 kPa at 0.04 s and 2 more");
}

}  // namespace
}  // namespace softgrip::sysid::isolated_values_test
