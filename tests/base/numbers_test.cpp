#include "base/numbers.h"

#include <limits>

#include <gtest/gtest.h>

namespace softgrip::numbers_test {
namespace {

TEST(Numbers, FormattedNumbersOmitUselessZerosAndMinusZero) {
  EXPECT_EQ(significant(58), "58");
  EXPECT_EQ(significant(0.07386, 3), "0.0739");
  EXPECT_EQ(significant(-0.0), "0");
  EXPECT_EQ(significant(1234.5, 3), "1234");
  EXPECT_EQ(significant(5e-8), "5e-08");
  EXPECT_EQ(significant(-1.25e9, 4), "-1.25e+09");
  EXPECT_EQ(fixed(-0.001, 2), "0.00");
}

TEST(Numbers, NaNAndInfinityAreFormattedAsADash) {
  for (const double none :
       {std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(significant(none), "-");
    EXPECT_EQ(fixed(none, 2), "-");
  }
}

TEST(Numbers, WrittenAvoidsAnExponentForShortNumbers) {
  EXPECT_EQ(shortest(100000), "1e+05");
  EXPECT_EQ(written(100000), "100000");
  EXPECT_EQ(written(0.0001), "0.0001");
  EXPECT_EQ(written(1e12), "1e+12");
  EXPECT_EQ(written(std::numeric_limits<double>::infinity()), "inf");
}

TEST(Numbers, FormattedNumbersParseToTheSameValue) {
  for (const double value : {0.1 + 0.2, 1e-300, -1.0 / 3, 5e15}) {
    EXPECT_EQ(to_number(shortest(value)), value);
    EXPECT_EQ(to_number(written(value)), value);
  }
  EXPECT_FALSE(to_number("1,5"));
}

}  // namespace
}  // namespace softgrip::numbers_test
