#include "sysid/structure/held_out_blocks.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sysid/fitting/trajectory.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::held_out_blocks_test {
namespace {

using model::SignalName;

TEST(HeldOutBlocks, EveryReadingIsJudgedOnceAndNeverWhereItWasFitted) {
  const model::Model twin = loaded("bench_twin");
  const std::vector<Record> records = make_records(
      {simulated(twin, SignalName::tp1, 50, 0.05, 1), simulated(twin, SignalName::steps, 50, 0.05, 2)}, {});
  const HeldOutBlocks blocks(records);
  std::vector<std::size_t> hidden(records.size(), 0);
  for (std::size_t fold = 0; fold < HeldOutBlocks::folds; ++fold) {
    for (std::size_t r = 0; r < records.size(); ++r) {
      EXPECT_LE(blocks.without(fold)[r].readings, records[r].readings);
      hidden[r] += records[r].readings - blocks.without(fold)[r].readings;
    }
  }
  // All once, and a tenth of a block on either side besides.
  for (std::size_t r = 0; r < records.size(); ++r) {
    EXPECT_GE(hidden[r], records[r].readings);
    EXPECT_LE(hidden[r], records[r].readings * 5 / 4);
  }
  // A model that is off by a millimetre everywhere loses one square millimetre in every block.
  FitPoint off{twin, rest_starts(twin, records)};
  std::vector<Record> shifted = records;
  for (std::size_t r = 0; r < records.size(); ++r) {
    shifted[r].reading_mm = predict(twin, records[r], off.starts[r]);
    off.starts[r].offset_mm = 1;
  }
  const HeldOutBlocks judge(shifted);
  std::vector<double> losses(judge.count(), -1);
  for (std::size_t fold = 0; fold < HeldOutBlocks::folds; ++fold) judge.judge(off, fold, losses);
  for (const double loss : losses) EXPECT_NEAR(loss, 1, 1e-9);
  EXPECT_NEAR(held_out_rmse_mm(losses), 1, 1e-9);
}

TEST(HeldOutBlocks, TheDifferenceComesWithItsStandardError) {
  const LossDifference same = loss_difference({1, 2, 3, 4}, {1, 2, 3, 4});
  EXPECT_EQ(same.mean_mm2, 0);
  EXPECT_EQ(same.standard_error_mm2, 0);
  const LossDifference worse = loss_difference({2, 2, 4, 4}, {1, 1, 1, 1});
  EXPECT_DOUBLE_EQ(worse.mean_mm2, 2);
  EXPECT_DOUBLE_EQ(worse.standard_error_mm2, std::sqrt(4.0 / 3 / 4));
}

TEST(HeldOutBlocks, AreClearlyLessInTheMeanOrInMostOfThem) {
  EXPECT_TRUE(is_clearly_less({1, 1, 1, 1}, {2, 2, 4, 4}));
  EXPECT_TRUE(is_clearly_less({1, 1, 1, 30}, {2, 2, 2, 90})) << "one block is hard for both";
  EXPECT_FALSE(is_clearly_less({1, 2, 3, 4}, {1, 2, 3, 4}));
  EXPECT_FALSE(is_clearly_less({1, 1, 1, 90}, {2, 2, 2, 30})) << "worse in the mean";
  EXPECT_FALSE(is_clearly_less({1, 3, 1, 3}, {3, 1, 3, 1.5}));
}

}  // namespace
}  // namespace softgrip::sysid::held_out_blocks_test
