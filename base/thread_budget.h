#pragma once
// Limits the number of threads that compute at the same time for one task.
// Ends a long computation early. The request to end is stored in the thread budget of the computation. All
// threads of the computation can read this request from the thread budget. Therefore, no function needs an
// argument for the request.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <stop_token>
#include <thread>
#include <utility>

namespace softgrip {

/// The number of threads that a task may use. All calls of parallel_for() in the task and in its threads
/// share this budget. Threads that an outer loop no longer needs at its end are available to the inner loops.
/// If each call writes its result to an array element of its own, the result does not depend on the number of
/// threads.
class ThreadBudget {
 public:
  /// Sets the budget of the calling thread, and of the threads started from it, until the destructor runs. At
  /// most `threads` threads (0: one per core) compute at a time, including the calling thread. If the calling
  /// thread already has a budget, the new budget has no effect.
  /// @param stop  requests an early end of the task (base/thread_budget.h).
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

  /// Returns the budget of the calling thread; nullptr if the thread has no budget.
  [[nodiscard]] static ThreadBudget* current() noexcept { return current_; }

  /// Returns true if the task must end early.
  [[nodiscard]] bool stop_requested() const noexcept { return stop_.stop_requested(); }

  /// Reserves at most `wanted` threads of the budget and returns the number of reserved threads.
  [[nodiscard]] std::size_t take(std::size_t wanted) noexcept {
    std::ptrdiff_t idle = idle_.load(std::memory_order_relaxed);
    while (idle > 0) {
      const std::ptrdiff_t taken = std::min(idle, static_cast<std::ptrdiff_t>(wanted));
      if (idle_.compare_exchange_weak(idle, idle - taken)) return static_cast<std::size_t>(taken);
    }
    return 0;
  }
  void give_back(std::size_t threads) noexcept { idle_ += static_cast<std::ptrdiff_t>(threads); }
  /// Counts the calling thread as computing, after it has waited for other threads. Until one of the other
  /// threads ends, the number of computing threads may exceed the budget by one.
  void go_on() noexcept { --idle_; }

  /// Sets the budget of the calling thread until this thread ends. A thread that was started to compute for a
  /// budget calls this function.
  static void share(ThreadBudget& budget) noexcept { current_ = &budget; }

 private:
  std::atomic<std::ptrdiff_t> idle_{0};
  std::stop_token stop_;
  inline static thread_local ThreadBudget* current_ = nullptr;
};

/// Exception that end_if_cancelled() throws. Only the function that created the thread budget catches this
/// exception.
struct WorkCancelled {};

/// Returns true if the computation of the calling thread must end early.
[[nodiscard]] inline bool is_cancelled() noexcept {
  const ThreadBudget* const budget = ThreadBudget::current();
  return budget != nullptr && budget->stop_requested();
}

/// Throws WorkCancelled if the computation of the calling thread must end early. The loops of a fit call this
/// function. Therefore, the fit ends within the time that one simulation of the model takes.
inline void end_if_cancelled() {
  if (is_cancelled()) throw WorkCancelled{};
}

}  // namespace softgrip
