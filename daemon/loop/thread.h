#pragma once
// A thread with a name and a stack of known size. Exceptions in the thread are reported.

#include <pthread.h>

#include <cstddef>
#include <functional>
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

}  // namespace softgrip::daemon
