#include "model/blocks/valve_deadband.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/model/drive.h"

namespace softgrip::model::testing::valve_deadband_test {
namespace {

using Block = ValveDeadband<double>;

TEST(ValveDeadband, IgnoresReversalsSmallerThanTheBand) {
  Block block = make<Block>({2.0});
  const std::vector<double> in{10, 8.5, 10, 9, 8, 7, 8.9, 9, 10};
  EXPECT_EQ(drive(block, 0, in, 0.1), (std::vector<double>{9, 9, 9, 9, 9, 8, 8, 8, 9}));
}

TEST(ValveDeadband, SplitsTheSegmentWhereThePressureBeginsToChange) {
  Block block = make<Block>({2.0});
  const auto out = pass(block, Segment<double>::straight(1.0, 0, 10));
  ASSERT_EQ(out.size(), 2u);
  EXPECT_NEAR(out[0].duration_s, 0.1, 1e-15);
  EXPECT_EQ(out[0].end, 0);
  EXPECT_EQ(out[1].end, 9);
  EXPECT_NEAR(out[1].mean, 4.5, 1e-12);
}

TEST(ValveDeadband, StepSizeDoesNotMatter) {
  Block once = make<Block>({3.0}), often = make<Block>({3.0});
  double from = 0;
  for (const double to : {12.0, 11.0, 3.0, 8.0, 7.5, 40.0, 0.0}) {
    pass(once, Segment<double>::straight(1.0, from, to));
    std::vector<double> fine;
    for (int i = 1; i <= 50; ++i) fine.push_back(from + (to - from) * i / 50);
    drive(often, from, fine, 0.02);
    EXPECT_NEAR(once.output(), often.output(), 1e-12);
    from = to;
  }
}

}  // namespace
}  // namespace softgrip::model::testing::valve_deadband_test
