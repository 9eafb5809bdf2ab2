#pragma once
// A named thread with a stack of known size. Exceptions in it are reported.

#include <pthread.h>

#include <cstddef>
#include <functional>
#include <string>

namespace softgrip::daemon {

/// The destructor joins the thread. The body must end by itself on request.
class Thread {
 public:
  struct Options {
    std::string name;  ///< at most 15 bytes, as shown by `ps -L` and the kernel
    /// Size of the stack. std::thread would need 8 MiB, and mlockall() would make all of it resident.
    std::size_t stack_bytes = 1024 * 1024;
  };

  Thread() = default;
  /// Throws std::system_error if the thread cannot be created. `on_exception` is called in the new thread
  /// with the text of an exception from `body`.
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
