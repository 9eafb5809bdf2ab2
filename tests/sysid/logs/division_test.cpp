#include "sysid/logs/division.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sysid/logs/resampled_record.h"

namespace softgrip::sysid::division_test {
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

std::size_t readings_of(const Record& record) {
  return static_cast<std::size_t>(std::count_if(record.reading_mm.begin(), record.reading_mm.end(),
                                                [](double y) { return std::isfinite(y); }));
}

/// Checks that every sample of every record is in exactly one block. Also checks that the samples of a block
/// are hidden while this block is held out.
void expect_each_sample_once(const std::vector<Record>& records, const Division& division) {
  std::vector<std::size_t> next(records.size());
  for (const Block& block : division.blocks) {
    EXPECT_EQ(block.first, next[block.record]);
    EXPECT_LE(block.hidden_first, block.first);
    EXPECT_GE(block.hidden_last, block.last);
    EXPECT_LE(block.hidden_last, records[block.record].size());
    EXPECT_LT(block.fold, division.folds);
    next[block.record] = block.last;
  }
  for (std::size_t r = 0; r < records.size(); ++r) EXPECT_EQ(next[r], records[r].size());
}

TEST(Division, HoldsEverySampleOutOnce) {
  const std::vector<Record> records{of_length(33, 100), of_length(20, 60)};
  for (const Division& division : {divide(records, 8), divide_into_fifths(records)}) {
    expect_each_sample_once(records, division);
    std::vector<std::size_t> hidden(records.size());
    for (std::size_t fold = 0; fold < division.folds; ++fold) {
      const std::vector<Record> rest = without_fold(records, division, fold);
      for (std::size_t r = 0; r < records.size(); ++r) {
        EXPECT_EQ(rest[r].readings, readings_of(rest[r]));
        hidden[r] += records[r].readings - rest[r].readings;
      }
    }
    for (std::size_t r = 0; r < records.size(); ++r) {
      EXPECT_GE(hidden[r], records[r].readings);
      EXPECT_LE(hidden[r], records[r].readings * 5 / 4)
          << "a margin of 1/10 of a block on each side of the block must also be hidden";
    }
  }
}

TEST(Division, NeighbouringBlocksAreNotHeldOutTogether) {
  const std::vector<Record> records{of_length(200, 20)};
  for (const Division& division : {divide(records, 8), divide_into_fifths(records)}) {
    for (std::size_t b = 1; b < division.blocks.size(); ++b)
      EXPECT_NE(division.blocks[b].fold, division.blocks[b - 1].fold);
  }
}

TEST(Division, HasNoBlockWithoutReadings) {
  std::vector<Record> records{of_length(40, 50), of_length(40, 50)};
  hide_readings(records[1], records[1].size() / 5, records[1].size() - 1);
  for (const Division& division :
       {divide(records, 8), divide_into_fifths(records), divide_into_halves(records)}) {
    EXPECT_EQ(std::count_if(division.blocks.begin(), division.blocks.end(),
                            [](const Block& block) { return block.record == 1; }),
              division.folds == 1 ? 1 : 2)
        << "the first fifth and the last sample are read";
    for (std::size_t b = 0; b < division.blocks.size(); ++b)
      EXPECT_EQ(division.blocks[b].fold, b % division.folds);
  }
}

TEST(Division, HasNoThinnedBlockWithoutReadings) {
  const std::vector<Record> records{of_length(40, 50)};
  std::vector<Record> thinned{thinned_record(records[0], 3)};
  hide_readings(thinned[0], 0, thinned[0].size() / 2);
  for (const Block& block : thinned_like(divide(records, 8), records, thinned).blocks)
    EXPECT_GT(block.last, thinned[0].size() / 2);
}

TEST(Division, HasBlocksIfThereAreNoReadings) {
  std::vector<Record> records{of_length(40, 50)};
  hide_readings(records[0], 0, records[0].size());
  EXPECT_FALSE(divide(records, 8).blocks.empty());
}

TEST(Division, HalvesFitTheFirstAndTestTheSecondHalf) {
  const std::vector<Record> records{of_length(33, 100), of_length(20, 60)};
  const Division halves = divide_into_halves(records);
  ASSERT_EQ(halves.folds, 1U);
  ASSERT_EQ(halves.blocks.size(), 10U);
  const std::vector<Record> first = without_fold(records, halves, 0);
  std::size_t judged = 0;
  for (const Block& block : halves.blocks) judged += block.last - block.first;
  for (std::size_t r = 0; r < records.size(); ++r) {
    EXPECT_EQ(first[r].readings, records[r].size() / 2);
    judged -= records[r].size() - first[r].readings;
  }
  EXPECT_EQ(judged, 0U);
}

TEST(Division, FirstShareOfReadingsIsKept) {
  const std::vector<Record> records{of_length(10, 100)};
  EXPECT_EQ(with_first_readings(records, 1).front().readings, records.front().readings);
  const Record first = with_first_readings(records, 0.3).front();
  EXPECT_EQ(first.readings, 300U);
  EXPECT_TRUE(std::isfinite(first.reading_mm[299]));
  EXPECT_TRUE(std::isnan(first.reading_mm[300]));
}

TEST(ThinnedDivision, HasTheSameTimeBlocks) {
  const std::vector<Record> records{of_length(33, 100), of_length(20, 60)};
  std::vector<Record> thinned;
  for (const Record& record : records) thinned.push_back(thinned_record(record, 3));
  const Division all = divide(records, 8);
  const Division few = thinned_like(all, records, thinned);
  ASSERT_EQ(few.blocks.size(), all.blocks.size());
  EXPECT_EQ(few.folds, all.folds);
  expect_each_sample_once(thinned, few);
  for (std::size_t b = 0; b < all.blocks.size(); ++b) {
    const Block& block = few.blocks[b];
    EXPECT_EQ(block.fold, all.blocks[b].fold);
    const Record& from = records[block.record];
    for (std::size_t i = block.first; i < block.last; ++i) {
      const double t_s = thinned[block.record].time_s[i];
      EXPECT_GE(t_s, from.time_s[all.blocks[b].first]);
      EXPECT_LE(t_s, from.time_s[all.blocks[b].last - 1]);
    }
  }
}

}  // namespace
}  // namespace softgrip::sysid::division_test
