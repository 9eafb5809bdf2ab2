#include "model/blocks/contact.h"

#include <gtest/gtest.h>

#include "tests/model/drive.h"

namespace softgrip::model::testing::contact_test {
namespace {

using Block = Contact<double>;

TEST(Contact, ReducesTheMotionOnlyBeyondTheContactPosition) {
  Block block = make<Block>({12.0, 3.0});
  const std::vector<double> in{5, 12, 16, 20, 12, 4};
  EXPECT_EQ(drive(block, 0, in, 0.1), (std::vector<double>{5, 12, 13, 14, 12, 4}));
}

TEST(Contact, PreservesTheMeanBelowTheContactPosition) {
  Block block = make<Block>({12.0, 3.0});
  pass(block, Segment<double>::straight(1, 0, 8));
  const auto out = pass(block, Segment<double>::straight(1, 8, 10));
  EXPECT_NEAR(out[0].mean, 9, 1e-12);
}

TEST(Contact, ResetPlacesTheOutputOnTheCharacteristic) {
  Block block = make<Block>({12.0, 3.0});
  block.reset(20.0);
  EXPECT_EQ(block.output(), 14);
}

}  // namespace
}  // namespace softgrip::model::testing::contact_test
