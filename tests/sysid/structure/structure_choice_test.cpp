#include "sysid/structure/structure_choice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

namespace softgrip::sysid::structure_choice_test {
namespace {

/// Returns a trial with the given mean square error of each held-out block.
StructureTrial trial(std::vector<double> block_losses_mm2) {
  StructureTrial made;
  const auto blocks = static_cast<double>(block_losses_mm2.size());
  made.heldout_rmse_mm =
      std::sqrt(std::accumulate(block_losses_mm2.begin(), block_losses_mm2.end(), 0.0) / blocks);
  made.block_losses_mm2 = std::move(block_losses_mm2);
  return made;
}

TEST(SimplestOfTheBest, IsTheSimplestStructureThatIsNotSignificantlyWorse) {
  EXPECT_EQ(simplest_of_the_best({trial({9, 9, 9, 9, 9}), trial({3, 1, 3, 1, 2}), trial({1, 3, 1, 3, 1.9})}),
            1u);
  EXPECT_EQ(simplest_of_the_best({trial({2, 2, 2, 2, 2}), trial({2, 2, 2, 2, 2})}), 0u);
}

TEST(SimplestOfTheBest, IsNotAStructureThatFailsInOneBlock) {
  const StructureTrial failing = trial({0.1, 0.12, 0.1, 0.11, 9}), better = trial({0.1, 0.1, 0.1, 0.1, 0.1});
  EXPECT_EQ(simplest_of_the_best({failing, better}), 1u)
      << "the difference is as large as its standard error, because one block determines both";
}

TEST(SimplestOfTheBest, IsNeverATrialThatMayNotBeChosen) {
  StructureTrial unbounded = trial({1, 1, 1}), inverse = trial({1, 1, 1});
  unbounded.bounded = false;
  inverse.invertible = false;
  EXPECT_EQ(simplest_of_the_best({unbounded, inverse, StructureTrial{}, trial({5, 5, 5})}), 3u);
}

}  // namespace
}  // namespace softgrip::sysid::structure_choice_test
