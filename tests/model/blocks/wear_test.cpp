#include "model/blocks/wear.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/model/drive.h"

namespace softgrip::model::testing::wear_test {
namespace {

using Block = Wear<double>;

TEST(Wear, GainChangesWithTheTotalTravelAcrossLogs) {
  Block block = make<Block>({-2.0});
  Surroundings around;
  around.time_s = 30;
  double way_mm = 0, from = 0;
  for (const double to : {10.0, 4.0, 4.0, 12.0}) {
    pass(block, Segment<double>::straight(1.0, from, to), around);
    way_mm += std::fabs(to - from);
    from = to;
    EXPECT_NEAR(block.output(), to * (1 - 2e-3 * way_mm), 1e-12);
  }
  block.rest(0);  // begins the next log of the campaign; the wear remains
  pass(block, Segment<double>::straight(1.0, 0, 5), around);
  EXPECT_NEAR(block.output(), 5 * (1 - 2e-3 * (way_mm + 5)), 1e-12);
  block.reset(0);
  pass(block, Segment<double>::straight(1.0, 0, 5), around);
  EXPECT_NEAR(block.output(), 5 * (1 - 2e-3 * 5), 1e-12);
}

}  // namespace
}  // namespace softgrip::model::testing::wear_test
