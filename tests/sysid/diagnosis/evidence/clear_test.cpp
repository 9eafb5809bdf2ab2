#include "sysid/diagnosis/evidence/evidence.h"

#include <gtest/gtest.h>

#include <limits>

namespace softgrip::sysid::clear_test {
namespace {

TEST(Clear, RequiresAPValueBelow2Percent) {
  EXPECT_TRUE(is_clear(0, 50));
  EXPECT_TRUE(is_clear(0.0199, 50));
  EXPECT_FALSE(is_clear(0.02, 50));
  EXPECT_FALSE(is_clear(1, 50));
}

TEST(Clear, RequiresAtLeast5PercentOfTheVariance) {
  EXPECT_TRUE(is_clear(0.001, 5));
  EXPECT_FALSE(is_clear(0.001, 4.9));
}

TEST(Clear, MissingValuesAreNeverClear) {
  constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(is_clear(nothing, 50));
  EXPECT_FALSE(is_clear(0.001, nothing));
}

}  // namespace
}  // namespace softgrip::sysid::clear_test
