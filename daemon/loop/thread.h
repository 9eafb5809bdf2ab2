#pragma once
// A thread with a name and a stack of known size, whose exceptions are reported; and a flag that wakes a
// sleeping thread.

#include <pthread.h>

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <string>

namespace softgrip::daemon {

/// The destructor waits until the thread has ended. The function of the thread must end by itself on request.
class Thread {
 public:
  struct Options {
    std::string name;  ///< name that `ps -L` and the kernel show; at most 15 bytes
    /// Size of the stack. The stack of a std::thread has 8 MiB, and mlockall() would make all of it resident.
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

}  // namespace softgrip::daemon
