#include "model/blocks/ageing.h"

#include <gtest/gtest.h>

#include "tests/model/drive.h"

namespace softgrip::model::testing::ageing_test {
namespace {

using Block = Ageing<double>;

TEST(Ageing, GainDriftsWithTheMeasurementTime) {
  Block block = make<Block>({0.5});
  Surroundings later;
  later.time_s = 7200;
  pass(block, Segment<double>::straight(1.0, 0, 10), later);
  EXPECT_NEAR(block.output(), 20, 1e-12);
  Block weaker = make<Block>({-0.5});
  pass(weaker, Segment<double>::straight(1.0, 0, 10), later);
  EXPECT_NEAR(weaker.output(), 2.5,
              1e-12);  // below the linear range, the gain factor is -1/(4 x); here x = -1
}

}  // namespace
}  // namespace softgrip::model::testing::ageing_test
