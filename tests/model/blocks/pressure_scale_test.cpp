#include "model/blocks/pressure_scale.h"

#include <gtest/gtest.h>

#include "tests/model/drive.h"

namespace softgrip::model::testing::pressure_scale_test {
namespace {

TEST(PressureScale, ScalesThePressureByAConstantFactor) {
  auto block = make<PressureScale<double>>({0.9});
  const auto out = pass(block, Segment<double>{0.5, 0, 40, 25});
  ASSERT_EQ(out.size(), 1U);
  EXPECT_EQ(out[0].duration_s, 0.5);
  EXPECT_EQ(out[0].begin, 0);
  EXPECT_EQ(out[0].end, 36);
  EXPECT_EQ(out[0].mean, 22.5);
  block.reset(10);
  EXPECT_EQ(block.output(), 9);
  EXPECT_EQ(block.peek(0.0, 20.0, {}), 18);
}

}  // namespace
}  // namespace softgrip::model::testing::pressure_scale_test
