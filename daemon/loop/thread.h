#pragma once
// A named thread with a stack of known size whose exceptions do not end the process unseen.

#include <pthread.h>

#include <cstddef>
#include <functional>
#include <string>

namespace softgrip::daemon {

/// Joins on destruction at the latest. The body must end by itself on request.
class Thread {
 public:
  struct Options {
    std::string name;  ///< at most 15 bytes, as `ps -L` and the kernel show it
    /// std::thread would take 8 MiB, all of it resident under mlockall.
    std::size_t stack_bytes = 1024 * 1024;
  };

  Thread() = default;
  /// Throws std::system_error if there is no thread to be had. `on_exception` is called in the new thread
  /// with the text of an exception that left `body`.
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
