#include "sysid/diagnosis/search/holdout.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sysid/diagnosis/search/search.h"
#include "sysid/logs/resampled_record.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::holdout_test {
namespace {

Record of_length(double length_s, double rate_hz) {
  Record record;
  for (int i = 0; i <= static_cast<int>(length_s * rate_hz); ++i) {
    record.time_s.push_back(i / rate_hz);
    record.duration_s.push_back(i == 0 ? 0 : 1 / rate_hz);
    record.drive_kpa.push_back(0);
    record.reading_mm.push_back(0);
  }
  record.sample_time_s = 1 / rate_hz;
  record.readings = record.size();
  return record;
}

TEST(ThinnedDivision, HasTheSameStretchesOfTime) {
  const std::vector<Record> records{of_length(33, 100), of_length(20, 60)};
  std::vector<Record> thinned;
  for (const Record& record : records) thinned.push_back(thinned_record(record, 3));
  const Division all = divide(records, 8);
  const Division few = thinned_like(all, records, thinned);
  ASSERT_EQ(few.blocks.size(), all.blocks.size());
  EXPECT_EQ(few.folds, all.folds);
  std::vector<std::size_t> next(records.size());
  for (std::size_t b = 0; b < all.blocks.size(); ++b) {
    const Block& block = few.blocks[b];
    EXPECT_EQ(block.fold, all.blocks[b].fold);
    EXPECT_EQ(block.first, next[block.record]) << "no sample in two blocks, nor in none";
    next[block.record] = block.last;
    const Record& from = records[block.record];
    for (std::size_t i = block.first; i < block.last; ++i) {
      const double t_s = thinned[block.record].time_s[i];
      EXPECT_GE(t_s, from.time_s[all.blocks[b].first]);
      EXPECT_LE(t_s, from.time_s[all.blocks[b].last - 1]);
    }
  }
  for (std::size_t r = 0; r < records.size(); ++r) EXPECT_EQ(next[r], thinned[r].size());
}

TEST(HeldOutLosses, AreAtMostTheSpansSquare) {
  std::vector<Record> records =
      make_records({simulated(loaded("bench_twin"), model::SignalName::tp1, 25, 0.05, 3)}, {});
  const SearchData data = make_search_data(records, loaded("zhang2025"));
  const StructureFit fit = evaluate_structure(records, {}, data.given);
  const Division division = divide(records, 8);
  const BlockLosses losses = held_out_losses(records, division, fit);
  const double most = *std::max_element(losses.begin(), losses.end());
  EXPECT_LT(most, records[0].span_mm * records[0].span_mm);
  records[0].span_mm = 0.5 * std::sqrt(most);
  const BlockLosses cut = held_out_losses(records, division, fit);
  for (std::size_t b = 0; b < losses.size(); ++b)
    EXPECT_DOUBLE_EQ(cut[b], std::min(losses[b], 0.25 * most)) << b;
}

TEST(IsMissed, WhereEveryDrawOfBlocksSaysSoAndItIsWorthSomething) {
  const BlockLosses with(12, 1.0), without(12, 1.5);
  EXPECT_TRUE(is_missed(without, with, 0.4, 1));
  EXPECT_FALSE(is_missed(without, with, 0.6, 1)) << "worth less";
  EXPECT_FALSE(is_missed(with, without, 0.4, 1)) << "better without";
  BlockLosses by_one_block = with;
  by_one_block.front() = 13;
  EXPECT_FALSE(is_missed(by_one_block, with, 0.4, 1)) << "a mean of 1, of one block alone";
}

TEST(MeanLogRatio, OneBlockThatWentAstrayDoesNotOutweighTheOthers) {
  BlockLosses worse(12, 2.0), better(12, 1.0);
  better.front() = 15;
  EXPECT_LT(mean_difference(worse, better, 1).lower, 0);
  const Spread ratio = mean_log_ratio(worse, better, 1);
  EXPECT_GT(ratio.lower, 0);
  EXPECT_NEAR(ratio.value, (11 * std::log(2.0) - std::log(7.5)) / 12, 1e-12);
  const Spread back = mean_log_ratio(better, worse, 1);
  EXPECT_LT(back.upper, 0);
}

TEST(MeanLogRatio, ABlockWithoutLossIsATie) {
  const Spread ratio = mean_log_ratio({0, 4, 4, 4}, {1, 4, 0, 4}, 1);
  EXPECT_EQ(ratio.value, 0);
  EXPECT_EQ(ratio.lower, 0);
  EXPECT_EQ(ratio.upper, 0);
}

}  // namespace
}  // namespace softgrip::sysid::holdout_test
