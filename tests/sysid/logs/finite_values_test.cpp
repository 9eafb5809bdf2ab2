#include "sysid/logs/finite_values.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace softgrip::sysid::finite_values_test {
namespace {

using Column = std::vector<double>;

const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
const Column gaps{nan, 2, infinity, 4, -infinity, 3};

TEST(FiniteValues, KeepTheIndicesOfTheirSamples) {
  const FiniteValues finite = finite_values(gaps);
  EXPECT_EQ(finite.values, (Column{2, 4, 3}));
  EXPECT_EQ(finite.samples, (std::vector<std::size_t>{1, 3, 5}));
  EXPECT_EQ(finite_count(gaps), 3U);
  EXPECT_TRUE(finite_values(Column{nan}).values.empty());
}

TEST(FillMissing, InterpolatesBetweenNeighboursAndRepeatsTheNearestValueAtTheEnds) {
  Column column{nan, 2, nan, nan, 5, nan};
  fill_missing(column);
  EXPECT_EQ(column, (Column{2, 2, 3, 4, 5, 5}));
  Column none{nan, nan};
  fill_missing(none);
  EXPECT_EQ(finite_count(none), 0U);
}

TEST(FiniteValues, ExtentIsFromTheLowestToTheHighestValue) {
  const auto extent = extent_of(Column{3, -1, 7, 0.5});
  ASSERT_TRUE(extent);
  EXPECT_EQ(extent->lowest, -1);
  EXPECT_EQ(extent->highest, 7);
  EXPECT_EQ(extent->width(), 8);
  EXPECT_EQ(extent_of(gaps)->lowest, 2);
  EXPECT_EQ(extent_of(gaps)->highest, 4);
  EXPECT_EQ(width_of(gaps), 2);
}

TEST(FiniteValues, ColumnWithoutFiniteValuesHasNoExtent) {
  for (const Column& column : {Column{}, Column{nan, nan}}) {
    EXPECT_FALSE(extent_of(column));
    EXPECT_EQ(width_of(column), 0);
    EXPECT_FALSE(varies(column));
    EXPECT_EQ(largest_step(column), 0);
  }
}

TEST(FiniteValues, RoundingErrorsAreNoVariation) {
  EXPECT_TRUE(varies(Column{20, nan, 20.1}));
  EXPECT_FALSE(varies(Column{20, nan, 20}));
  EXPECT_FALSE(varies(Column{1e6, 1e6 + 0.5}));
}

TEST(FiniteValues, StepsAreBetweenNeighbouringFiniteValues) {
  EXPECT_EQ(largest_step(Column{0, 1, nan, 4, 3}), 3);
  EXPECT_EQ(largest_step(Column{5}), 0);
}

}  // namespace
}  // namespace softgrip::sysid::finite_values_test
