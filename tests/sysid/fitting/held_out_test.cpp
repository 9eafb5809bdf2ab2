#include "sysid/fitting/held_out.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "sysid/fitting/trajectory.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::held_out_test {
namespace {

using model::SignalName;

struct Predicted {
  model::Model twin = loaded("bench_twin");
  std::vector<Record> records = make_records(
      {simulated(twin, SignalName::tp1, 50, 0.05, 1), simulated(twin, SignalName::steps, 50, 0.05, 2)}, {});
  FitPoint point{twin, rest_starts(twin, records)};

  /// Sets the readings to the prediction of the model. The start states have the offset `off_mm`.
  explicit Predicted(double off_mm) {
    for (std::size_t r = 0; r < records.size(); ++r) {
      records[r].reading_mm = predict(twin, records[r], point.starts[r]);
      point.starts[r].offset_mm = off_mm;
    }
  }
};

TEST(HeldOutLosses, OneMillimetreErrorGivesALossOfOneInEveryBlock) {
  const Predicted off(1);
  for (const Division& division :
       {divide(off.records, 8), divide_into_fifths(off.records), divide_into_halves(off.records)}) {
    const BlockLosses losses =
        held_out_losses(off.records, division, [&](const std::vector<Record>&) { return off.point; });
    ASSERT_EQ(losses.size(), division.blocks.size());
    for (const double loss : losses) EXPECT_NEAR(loss, 1, 1e-9);
    EXPECT_NEAR(rmse_mm(losses), 1, 1e-9);
  }
}

TEST(HeldOutLosses, ComeFromAFitWithoutTheBlock) {
  const Predicted exact(0);
  const Division division = divide_into_fifths(exact.records);
  // This function replaces the fit. It counts the readings of the last block of the second log and returns
  // this number as the offset. If the block is hidden, the number is 0.
  const Block last = division.blocks.back();
  const BlockLosses losses = held_out_losses(exact.records, division, [&](const std::vector<Record>& rest) {
    double seen = 0;
    for (std::size_t i = last.first; i < last.last; ++i)
      seen += std::isfinite(rest[last.record].reading_mm[i]) ? 1 : 0;
    FitPoint point = exact.point;
    point.starts[last.record].offset_mm = seen;
    return point;
  });
  EXPECT_NEAR(losses.back(), 0, 1e-18);
}

TEST(HeldOutLosses, DoNotDecreaseIfReadingsAreMissing) {
  Predicted off(1);
  hide_readings(off.records[1], off.records[1].size() / 4, off.records[1].size());
  for (const Division& division :
       {divide(off.records, 8), divide_into_fifths(off.records), divide_into_halves(off.records)}) {
    EXPECT_NEAR(rmse_mm(held_out_losses(off.records, division,
                                        [&](const std::vector<Record>&) { return off.point; })),
                1, 1e-9);
  }
}

TEST(HeldOutLosses, EqualTheSquaredSpanForALargeError) {
  const Predicted far(1e6);
  const Division division = divide(far.records, 8);
  const BlockLosses losses =
      held_out_losses(far.records, division, [&](const std::vector<Record>&) { return far.point; });
  for (std::size_t b = 0; b < losses.size(); ++b) {
    const double span_mm = far.records[division.blocks[b].record].span_mm;
    EXPECT_EQ(losses[b], span_mm * span_mm);
  }
}

TEST(StatisticOfDraws, EachDrawHasTheBlockCountAndDependsOnTheSeed) {
  const auto sum = [](std::span<const std::size_t> indices) {
    EXPECT_EQ(indices.size(), 5U);
    double total = 0;
    for (const std::size_t i : indices) total += static_cast<double>(i);
    return total;
  };
  const std::vector<double> draws = statistic_of_draws(5, 200, 7, sum);
  ASSERT_EQ(draws.size(), 200U);
  EXPECT_EQ(draws, statistic_of_draws(5, 200, 7, sum));
  EXPECT_NE(draws, statistic_of_draws(5, 200, 8, sum));
  const auto [least, most] = std::minmax_element(draws.begin(), draws.end());
  EXPECT_LT(*least, *most);
  EXPECT_GE(*least, 0);
  EXPECT_LE(*most, 20);
}

TEST(WinningShare, CountsTiesHalf) {
  EXPECT_EQ(winning_share({1, 1, 1}, {2, 2, 2}, 1), 1);
  EXPECT_EQ(winning_share({2, 2, 2}, {1, 1, 1}, 1), 0);
  EXPECT_EQ(winning_share({1, 2, 3}, {1, 2, 3}, 1), 0.5);
}

TEST(IsMissed, RequiresALargeLossReductionInEveryResample) {
  const BlockLosses with(12, 1.0), without(12, 1.5);
  EXPECT_TRUE(is_missed(without, with, 0.4, 1));
  EXPECT_FALSE(is_missed(without, with, 0.6, 1)) << "the mean difference of the losses is smaller than 0.6";
  EXPECT_FALSE(is_missed(with, without, 0.4, 1)) << "the losses of the first model are smaller";
  BlockLosses by_one_block = with;
  by_one_block.front() = 13;
  EXPECT_FALSE(is_missed(by_one_block, with, 0.4, 1))
      << "a single block causes the complete mean difference of 1";
}

TEST(MeanLogRatio, OneOutlyingBlockDoesNotDominate) {
  BlockLosses worse(12, 2.0), better(12, 1.0);
  better.front() = 15;
  EXPECT_LT(mean_difference(worse, better, 1).lower, 0);
  const Spread ratio = mean_log_ratio(worse, better, 1);
  EXPECT_GT(ratio.lower, 0);
  EXPECT_NEAR(ratio.value, (11 * std::log(2.0) - std::log(7.5)) / 12, 1e-12);
  const Spread back = mean_log_ratio(better, worse, 1);
  EXPECT_LT(back.upper, 0);
}

TEST(MeanLogRatio, BlockWithZeroLossCountsAsATie) {
  const Spread ratio = mean_log_ratio({0, 4, 4, 4}, {1, 4, 0, 4}, 1);
  EXPECT_EQ(ratio.value, 0);
  EXPECT_EQ(ratio.lower, 0);
  EXPECT_EQ(ratio.upper, 0);
}

TEST(LossDifference, StandardErrorMatchesTheBlockScatter) {
  const LossDifference same = loss_difference({1, 2, 3, 4}, {1, 2, 3, 4});
  EXPECT_EQ(same.mean_mm2, 0);
  EXPECT_EQ(same.standard_error_mm2, 0);
  const LossDifference worse = loss_difference({2, 2, 4, 4}, {1, 1, 1, 1});
  EXPECT_DOUBLE_EQ(worse.mean_mm2, 2);
  EXPECT_DOUBLE_EQ(worse.standard_error_mm2, std::sqrt(4.0 / 3 / 4));
}

TEST(IsClearlyLess, ComparesTheMeanAndTheMajorityOfBlocks) {
  EXPECT_TRUE(is_clearly_less({1, 1, 1, 1}, {2, 2, 4, 4}));
  EXPECT_TRUE(is_clearly_less({1, 1, 1, 30}, {2, 2, 2, 90})) << "one block has a large loss with both models";
  EXPECT_FALSE(is_clearly_less({1, 2, 3, 4}, {1, 2, 3, 4}));
  EXPECT_FALSE(is_clearly_less({1, 1, 1, 90}, {2, 2, 2, 30})) << "the mean loss of the first model is larger";
  EXPECT_FALSE(is_clearly_less({1, 3, 1, 3}, {3, 1, 3, 1.5}));
}

}  // namespace

}  // namespace softgrip::sysid::held_out_test
