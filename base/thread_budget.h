#pragma once
// How many threads may compute at a time for one piece of work, wherever in it they are needed.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <stop_token>
#include <thread>
#include <utility>

namespace softgrip {

/// Threads that a piece of work may use. What parallel_for() starts below the thread that made it shares it:
/// where the last items of an outer loop leave threads idle, the loops within them take these. The answer of
/// a work that puts its results into slots of their own does not depend on who computed them.
class ThreadBudget {
 public:
  /// From here to its end, for the calling thread and for those that are started below it: `threads` at a
  /// time (0: as many as there are cores), the calling one among them. Changes nothing where the thread has a
  /// budget.
  /// @param stop  requests an early end of the work (base/cancellation.h).
  explicit ThreadBudget(unsigned threads, std::stop_token stop = {}) noexcept : stop_(std::move(stop)) {
    if (current_ != nullptr) return;
    const std::size_t all = threads != 0 ? threads : std::max(1U, std::thread::hardware_concurrency());
    idle_ = static_cast<std::ptrdiff_t>(all) - 1;
    current_ = this;
  }
  ~ThreadBudget() {
    if (current_ == this) current_ = nullptr;
  }
  ThreadBudget(const ThreadBudget&) = delete;
  ThreadBudget& operator=(const ThreadBudget&) = delete;

  /// The calling thread's; nullptr: it has none.
  [[nodiscard]] static ThreadBudget* current() noexcept { return current_; }

  /// True if the work shall end early.
  [[nodiscard]] bool stop_requested() const noexcept { return stop_.stop_requested(); }

  /// At most `wanted` more threads; how many there are.
  [[nodiscard]] std::size_t take(std::size_t wanted) noexcept {
    std::ptrdiff_t idle = idle_.load(std::memory_order_relaxed);
    while (idle > 0) {
      const std::ptrdiff_t taken = std::min(idle, static_cast<std::ptrdiff_t>(wanted));
      if (idle_.compare_exchange_weak(idle, idle - taken)) return static_cast<std::size_t>(taken);
    }
    return 0;
  }
  void give_back(std::size_t threads) noexcept { idle_ += static_cast<std::ptrdiff_t>(threads); }
  /// Of one that waited and goes on: for a moment more may compute than there are threads.
  void go_on() noexcept { --idle_; }

  /// Makes a budget that of the calling thread, which was started for it, until it ends.
  static void share(ThreadBudget& budget) noexcept { current_ = &budget; }

 private:
  std::atomic<std::ptrdiff_t> idle_{0};
  std::stop_token stop_;
  inline static thread_local ThreadBudget* current_ = nullptr;
};

}  // namespace softgrip
