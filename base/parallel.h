#pragma once
// The same work for many items, on a few threads.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace softgrip {

/// Calls work(i) for i in [0, count), in any order, on `threads` threads (0: as many as there are cores).
/// The first exception is passed on when all are done. Results belong into slot i of something prepared.
template <class Work>
void parallel_for(std::size_t count, unsigned threads, Work&& work) {
  const std::size_t cores = threads != 0 ? threads : std::max(1U, std::thread::hardware_concurrency());
  const std::size_t used = std::min(cores, count);
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex failure_mutex;
  const auto run = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        work(i);
      } catch (...) {
        const std::lock_guard lock(failure_mutex);
        if (!failure) failure = std::current_exception();
      }
    }
  };
  std::vector<std::jthread> others;
  for (std::size_t i = 1; i < used; ++i) others.emplace_back(run);
  run();
  others.clear();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace softgrip
