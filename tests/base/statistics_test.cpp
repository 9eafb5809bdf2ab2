#include "base/statistics.h"

#include <array>
#include <vector>

#include <gtest/gtest.h>

namespace softgrip {
namespace {

TEST(Median, IsTheUpperOneOfTwoInTheMiddle) {
  std::vector<double> odd{5, 1, 9}, even{4, 1, 3, 2}, none;
  EXPECT_EQ(median_of(std::span(odd)), 5);
  EXPECT_EQ(median_of(std::span(even)), 3);
  EXPECT_EQ(median_of(std::span(none)), 0);
  std::array<int, 4> part{7, 8, 9, -1};
  EXPECT_EQ(median_of(std::span(part).first(3)), 8);
}

TEST(TQuantile, MatchesTables) {
  EXPECT_NEAR(t_quantile(3), 3.182, 0.03);
  EXPECT_NEAR(t_quantile(10), 2.228, 0.001);
  EXPECT_NEAR(t_quantile(30), 2.042, 0.0005);
  EXPECT_NEAR(t_quantile(1e9), 1.95996, 1e-5);
}

}  // namespace
}  // namespace softgrip
