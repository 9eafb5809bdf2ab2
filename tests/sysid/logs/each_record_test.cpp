#include "sysid/logs/each_record.h"

#include <limits>
#include <set>
#include <thread>

#include <gtest/gtest.h>

#include "base/thread_budget.h"

namespace softgrip::sysid::each_record_test {
namespace {

/// Returns a record in which every second sample has a reading.
Record record_of(std::size_t samples) {
  Record record;
  for (std::size_t i = 0; i < samples; ++i) {
    record.time_s.push_back(0.01 * static_cast<double>(i));
    record.drive_kpa.push_back(1);
    record.reading_mm.push_back(i % 2 == 0 ? 1 : std::numeric_limits<double>::quiet_NaN());
    record.readings += i % 2 == 0 ? 1 : 0;
  }
  return record;
}

TEST(EachRecord, EachRecordIsProcessedOnce) {
  const ThreadBudget budget(3);
  for (const std::size_t samples : {std::size_t{1}, samples_worth_a_thread}) {
    const std::vector<Record> records(5, record_of(samples));
    std::vector<int> done(records.size(), 0);
    for_each_record(records, [&](std::size_t k) { ++done[k]; });
    EXPECT_EQ(done, std::vector<int>(records.size(), 1));
  }
}

TEST(EachRecord, ShortRecordsUseTheCallingThread) {
  const ThreadBudget budget(3);
  const std::vector<Record> records(5, record_of(samples_worth_a_thread - 1));
  EXPECT_FALSE(are_worth_threads(records));
  std::set<std::thread::id> threads;
  for_each_record(records, [&](std::size_t) { threads.insert(std::this_thread::get_id()); });
  EXPECT_EQ(threads, std::set{std::this_thread::get_id()});
}

TEST(EachRecord, FirstRowsCountReadings) {
  EXPECT_EQ(first_rows_of({record_of(7), record_of(2), record_of(5)}), (std::vector<std::size_t>{0, 4, 5}));
}

}  // namespace
}  // namespace softgrip::sysid::each_record_test
