#pragma once
// Receives signals in a waiting call instead of in a signal handler.

#include <array>
#include <csignal>
#include <ctime>

#include "base/periodic_schedule.h"

namespace softgrip::daemon {

/// While this object exists, all signals that request the end of the process are blocked in the calling
/// thread and in the threads started from it. SIGPIPE and SIGXFSZ are ignored, because the failed call
/// reports the error. Signals with which a terminal stops a process are ignored, because a stopped loop
/// cannot hold a part.
class Signals {
 public:
  Signals() noexcept;
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;
  Signals(Signals&&) = delete;
  Signals& operator=(Signals&&) = delete;
  ~Signals();

  /// Returns the received signal, or 0 after `timeout`. Stores it as the signal that ends the process
  /// (ending_signal.h).
  [[nodiscard]] int wait(Nanoseconds timeout) noexcept;
  /// Reads all pending signals. Returns the first one that this object has ever read, or 0.
  [[nodiscard]] int first() noexcept;

 private:
  sigset_t set_{};
  sigset_t before_{};
  int first_ = 0;
  static constexpr std::array ignored{SIGPIPE, SIGXFSZ, SIGTSTP, SIGTTIN, SIGTTOU};
  std::array<struct sigaction, ignored.size()> ignored_before_{};
};

}  // namespace softgrip::daemon
