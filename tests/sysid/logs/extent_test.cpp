#include "sysid/logs/extent.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace softgrip::sysid::extent_test {
namespace {

TEST(ColumnExtent, IsFromTheLowestToTheHighestValue) {
  const auto extent = extent_of({3, -1, 7, 0.5});
  ASSERT_TRUE(extent);
  EXPECT_EQ(extent->lowest, -1);
  EXPECT_EQ(extent->highest, 7);
  EXPECT_EQ(extent->width(), 8);
}

TEST(ColumnExtent, LooksOverWhatIsNoNumber) {
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  const auto extent = extent_of({nan, 2, infinity, 4, -infinity});
  ASSERT_TRUE(extent);
  EXPECT_EQ(extent->lowest, 2);
  EXPECT_EQ(extent->highest, 4);
}

TEST(ColumnExtent, IsNoneWhereNoValueIsANumber) {
  EXPECT_FALSE(extent_of({}));
  EXPECT_FALSE(extent_of({std::nan(""), std::nan("")}));
}

}  // namespace
}  // namespace softgrip::sysid::extent_test
