#pragma once
// Defines three classes: threads with a name, a fixed stack size and reported exceptions; a flag that wakes a
// sleeping thread; and a check that threads are still running.

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include <pthread.h>

#include "base/time.h"

namespace softgrip::daemon {

/// A thread. The destructor waits until the thread has ended, so the caller must first request the end of the
/// thread's function.
class Thread {
 public:
  struct Options {
    std::string name;  ///< name of the thread for `ps -L` and the kernel; at most 15 bytes
    /// Size of the thread's stack. A std::thread has a stack of 8 MiB, and mlockall() would make the complete
    /// stack resident in memory.
    std::size_t stack_bytes = 1024 * 1024;
  };

  Thread() = default;
  /// Starts the thread. Throws std::system_error if the thread cannot be created. If `body` throws an
  /// exception, `on_exception` is called in the new thread with the text of the exception.
  Thread(const Options& options, std::function<void()> body,
         std::function<void(const std::string&)> on_exception);
  Thread(const Thread&) = delete;
  Thread& operator=(const Thread&) = delete;
  Thread(Thread&& other) noexcept;
  Thread& operator=(Thread&& other) noexcept;
  ~Thread();

  [[nodiscard]] bool joinable() const noexcept { return started_; }
  void join() noexcept;

 private:
  pthread_t handle_{};
  bool started_ = false;
};

/// A flag that another thread can set to wake a sleeping thread.
class StopFlag {
 public:
  void set();
  /// Waits until the flag is set, but at most for `timeout`. Returns true if the flag is set.
  bool wait(std::chrono::duration<double> timeout);
  bool is_set() { return wait(std::chrono::duration<double>(0)); }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool set_ = false;
};

/// Checks counters that threads increase while they run. Each counter has its own time-out: the bus thread
/// may block for a long time while it opens a connection, but the loop must never block.
class Heartbeat {
 public:
  /// `patience` contains the time-out of each counter [ns]. The time-outs start with the first call of
  /// beats().
  explicit Heartbeat(const std::vector<Nanoseconds>& patience);

  /// Returns false if a counter has not changed for longer than its time-out. `counts` contains the counters
  /// in the order of the constructor's time-outs.
  [[nodiscard]] bool beats(Nanoseconds now, const std::vector<std::uint64_t>& counts);

 private:
  struct Counter {
    Nanoseconds patience = 0;
    Nanoseconds grew_at = 0;
    std::uint64_t count = 0;
  };
  std::vector<Counter> counters_;
  bool begun_ = false;
};

}  // namespace softgrip::daemon
