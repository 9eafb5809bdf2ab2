#include "base/interpolation.h"

#include <gtest/gtest.h>

namespace softgrip::interpolation_test {
namespace {

TEST(Interpolation, IsLinearBetweenSamplesAndConstantOutside) {
  const std::vector<double> time_s{1, 2, 4}, values{10, 20, 0};
  const std::vector<double> at_s{0, 1, 1.25, 2, 3, 3, 4, 9};
  const std::vector<double> expected{10, 10, 12.5, 20, 10, 10, 0, 0};
  EXPECT_EQ(interpolated(time_s, values, at_s), expected);
}

TEST(Interpolation, OfOneSampleIsItsValue) {
  const std::vector<double> time_s{1}, values{7}, at_s{0, 1, 2};
  EXPECT_EQ(interpolated(time_s, values, at_s), (std::vector<double>{7, 7, 7}));
}

TEST(Interpolation, AtTheSamplesReturnsTheSamples) {
  const std::vector<double> time_s{0, 0.1, 0.4, 0.5}, values{3, -1, 2, 8};
  EXPECT_EQ(interpolated(time_s, values, time_s), values);
}

}  // namespace
}  // namespace softgrip::interpolation_test
