#include "sysid/fitting/interval.h"

#include <gtest/gtest.h>

namespace softgrip::sysid::interval_test {
namespace {

TEST(Interval, TextStatesTheBoundsOrAnUndeterminedValue) {
  EXPECT_EQ(text_of({0.127, 0.133}, 0.13, " .. "), "0.127 .. 0.133");
  EXPECT_EQ(text_of({-3, 3}, 0.13, " to "), "not determined by these logs");
  EXPECT_TRUE(is_determined({-1, 1}, -0.1));
  EXPECT_FALSE(is_determined({-1, 1.01}, -0.1));
}

}  // namespace
}  // namespace softgrip::sysid::interval_test
