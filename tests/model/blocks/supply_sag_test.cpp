#include "model/blocks/supply_sag.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/model/drive.h"

namespace softgrip::model::testing::supply_sag_test {
namespace {

using Block = SupplySag<double>;

Surroundings supply(double kpa) {
  Surroundings around;
  around.supply_kpa = kpa;
  return around;
}

TEST(SupplySag, PressureLossIsProportionalToTheLossOfSupply) {
  Block block = make<Block>({0.5, 500.0});
  pass(block, Segment<double>::straight(1.0, 0, 40), supply(400));
  EXPECT_NEAR(block.output(), 40 * (1 - 0.5 * 0.2), 1e-12);
  pass(block, Segment<double>::straight(1.0, 40, 40), supply(600));
  EXPECT_EQ(block.output(), 40);
}

TEST(SupplySag, HasNoEffectIfTheSupplyIsUnknown) {
  Block block = make<Block>({1.0, 10000.0});
  pass(block, Segment<double>::straight(1.0, 0, 40));
  EXPECT_EQ(block.output(), 40);
}

TEST(SupplySag, OutputSegmentsAreContinuous) {
  Block block = make<Block>({0.5, 500.0});
  double last = 0, from = 0;
  for (int i = 1; i < 200; ++i) {
    const double to = 30 + 20 * std::sin(0.1 * i);
    for (const auto& s :
         pass(block, Segment<double>::straight(0.01, from, to), supply(450 + 30 * std::cos(0.3 * i)))) {
      ASSERT_NEAR(s.begin, last, 1e-12);
      last = s.end;
    }
    from = to;
  }
}

}  // namespace
}  // namespace softgrip::model::testing::supply_sag_test
