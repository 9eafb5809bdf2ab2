#include "model/blocks/backlash.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/model/drive.h"

namespace softgrip::model::testing::backlash_test {
namespace {

using Block = Backlash<double>;

TEST(Backlash, LosesTheGapAtEveryReversal) {
  Block block = make<Block>({0.4});
  const auto out = drive(block, 0, std::vector<double>{10, 9.7, 9.5, 5, 5.3, 6}, 0.1);
  const std::vector<double> expected{9.8, 9.8, 9.7, 5.2, 5.2, 5.8};
  for (std::size_t i = 0; i < out.size(); ++i) EXPECT_NEAR(out[i], expected[i], 1e-12) << i;
}

}  // namespace
}  // namespace softgrip::model::testing::backlash_test
