#pragma once
// Receives signals by waiting for them, in place of a signal handler.

#include <array>
#include <csignal>

#include "base/periodic_schedule.h"

namespace softgrip::daemon {

/// While this object exists, all signals that request the end of the process are blocked in the calling
/// thread and in the threads that it starts. SIGPIPE and SIGXFSZ are ignored, because the system call that
/// fails also reports the error. The signals with which a terminal stops a process are ignored, because a
/// stopped loop cannot hold a part.
class Signals {
 public:
  Signals() noexcept;
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;
  Signals(Signals&&) = delete;
  Signals& operator=(Signals&&) = delete;
  ~Signals();

  /// Waits for a signal and returns it, or returns 0 after `timeout`. Stores this signal as the signal that
  /// ends the process (base/exit_code.h).
  [[nodiscard]] int wait(Nanoseconds timeout) noexcept;
  /// Reads all pending signals. Returns the first signal that this object has ever read; 0 if there is none.
  [[nodiscard]] int first() noexcept;

 private:
  sigset_t set_{};
  sigset_t before_{};
  int first_ = 0;
  static constexpr std::array ignored{SIGPIPE, SIGXFSZ, SIGTSTP, SIGTTIN, SIGTTOU};
  std::array<struct sigaction, ignored.size()> ignored_before_{};
};

}  // namespace softgrip::daemon
