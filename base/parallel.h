#pragma once
// Runs a function for many items on several threads.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <limits>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "base/thread_budget.h"

namespace softgrip {

/// Calls work(i) for each i in [0, count), in any order. The calls run on the calling thread and on idle
/// threads of the thread budget, but on at most `threads` threads (0: one per core). If a call throws an
/// exception, the first exception is thrown again after all threads have ended. After a request to end early,
/// no further call begins, and parallel_for() throws WorkCancelled. work(i) should write its result into
/// element i of a prepared array.
template <class Work>
void parallel_for(std::size_t count, unsigned threads, Work&& work) {
  ThreadBudget own(threads);
  ThreadBudget& budget = *ThreadBudget::current();
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex failure_mutex;
  const auto run = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        end_if_cancelled();
        work(i);
      } catch (...) {
        const std::lock_guard lock(failure_mutex);
        if (!failure) failure = std::current_exception();
      }
    }
  };
  const std::size_t most = threads != 0 ? threads : std::numeric_limits<std::size_t>::max();
  const std::size_t helpers = count > 1 ? budget.take(std::min(most, count) - 1) : 0;
  if (helpers == 0) {
    run();
  } else {
    std::vector<std::jthread> others;
    others.reserve(helpers);
    for (std::size_t i = 0; i < helpers; ++i) {
      others.emplace_back([&] {
        ThreadBudget::share(budget);
        run();
        budget.give_back(1);
      });
    }
    run();
    // From now on, the calling thread waits. Therefore, another thread of the budget may compute in its
    // place.
    budget.give_back(1);
    others.clear();
    budget.go_on();
  }
  if (failure) std::rethrow_exception(failure);
}

/// Calls work(i) for each i, as parallel_for() does. The calls run on the calling thread and on the idle
/// threads of its budget. If the calling thread has no budget, all calls run on this thread.
template <class Work>
void parallel_for_idle(std::size_t count, Work&& work) {
  parallel_for(count, ThreadBudget::current() != nullptr ? 0 : 1, std::forward<Work>(work));
}

}  // namespace softgrip
