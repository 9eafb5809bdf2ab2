#pragma once
// Calls a function for each record. The calls run in parallel if the records are so long that threads save
// time.

#include <cstddef>
#include <vector>

#include "base/parallel.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Number of samples below which simulating a record takes less time than starting a thread.
inline constexpr std::size_t samples_worth_a_thread = 1000;

/// Returns true if the records have at least `least_samples` samples on average.
[[nodiscard]] inline bool are_worth_threads(const std::vector<Record>& records,
                                            std::size_t least_samples = samples_worth_a_thread) {
  std::size_t samples = 0;
  for (const Record& record : records) samples += record.size();
  return samples >= least_samples * records.size();
}

/// Calls work(i) for i from 0 to `count` - 1 in any order. Each call of work(i) simulates records. If the
/// records have at least `least_samples` samples on average, the calls run on idle threads.
template <class Work>
void for_each_walk(const std::vector<Record>& records, std::size_t count, Work&& work,
                   std::size_t least_samples = samples_worth_a_thread) {
  if (are_worth_threads(records, least_samples)) {
    parallel_for_idle(count, work);
  } else {
    for (std::size_t i = 0; i < count; ++i) work(i);
  }
}

/// Calls work(k) for the index k of each record, in any order. If the records have at least `least_samples`
/// samples on average, the calls run on idle threads. work(k) must write its result to element k of a
/// container that exists before the call.
template <class Work>
void for_each_record(const std::vector<Record>& records, Work&& work,
                     std::size_t least_samples = samples_worth_a_thread) {
  for_each_walk(records, records.size(), work, least_samples);
}

/// Returns, for each record, the index of its first reading in a list of the readings of all records.
[[nodiscard]] inline std::vector<std::size_t> first_rows_of(const std::vector<Record>& records) {
  std::vector<std::size_t> rows;
  std::size_t row = 0;
  for (const Record& record : records) {
    rows.push_back(row);
    row += record.readings;
  }
  return rows;
}

}  // namespace softgrip::sysid
