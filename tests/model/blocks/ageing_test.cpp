#include "model/blocks/ageing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/model/drive.h"

namespace softgrip::model::testing {
namespace {

using Block = Ageing<double>;

TEST(Ageing, GainDriftsWithTheTimeOfTheCampaign) {
  Block block = make<Block>({0.5, 0.0, 60.0, 0.0});
  Surroundings later;
  later.time_s = 7200;
  pass(block, Segment<double>::straight(1.0, 0, 10), later);
  EXPECT_NEAR(block.output(), 20, 1e-12);
  Block weaker = make<Block>({-0.5, 0.0, 60.0, 0.0});
  pass(weaker, Segment<double>::straight(1.0, 0, 10), later);
  EXPECT_NEAR(weaker.output(), 2.5, 1e-12);  // -1/(4 x) at x = -1
}

TEST(Ageing, RunsInOverATime) {
  Block block = make<Block>({0.0, 0.2, 100.0, 0.0});
  Surroundings around;
  for (const double time_s : {0.0, 50.0, 100.0, 1e4}) {
    around.time_s = time_s;
    pass(block, Segment<double>::straight(1.0, 10, 10), around);
    EXPECT_NEAR(block.output(), 10 * (1 - 0.2 * std::expm1(-time_s / 100)), 1e-12) << time_s;
  }
}

TEST(Ageing, WearsWithTheWayGoneInTheCampaign) {
  Block block = make<Block>({0.0, 0.0, 60.0, -2.0});
  Surroundings around;
  around.time_s = 30;
  double way_mm = 0, from = 0;
  for (const double to : {10.0, 4.0, 4.0, 12.0}) {
    pass(block, Segment<double>::straight(1.0, from, to), around);
    way_mm += std::fabs(to - from);
    from = to;
    EXPECT_NEAR(block.output(), to * (1 - 2e-3 * way_mm), 1e-12);
  }
  block.rest(0);  // the next log of the campaign
  pass(block, Segment<double>::straight(1.0, 0, 5), around);
  EXPECT_NEAR(block.output(), 5 * (1 - 2e-3 * (way_mm + 5)), 1e-12);
  block.reset(0);
  pass(block, Segment<double>::straight(1.0, 0, 5), around);
  EXPECT_NEAR(block.output(), 5 * (1 - 2e-3 * 5), 1e-12);
}

}  // namespace
}  // namespace softgrip::model::testing
