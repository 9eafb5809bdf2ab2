#pragma once
// Signals as something to wait for, not as interruptions.

#include <array>
#include <csignal>
#include <ctime>

#include "base/periodic_schedule.h"

namespace softgrip::daemon {

/// As long as it lives, every signal that asks a process to end is blocked in the calling thread and in those
/// it starts; and ignored are SIGPIPE and SIGXFSZ, because a peer that is gone and a file that is too large
/// are errors of the call, and what a terminal sends to stop a process, because a loop that stands still
/// holds nothing.
class Signals {
 public:
  Signals() noexcept;
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;
  Signals(Signals&&) = delete;
  Signals& operator=(Signals&&) = delete;
  ~Signals();

  /// The signal that came, or 0 after `timeout`. It is noted as the process's ending signal
  /// (ending_signal.h).
  [[nodiscard]] int wait(Nanoseconds timeout) noexcept;
  /// Takes all signals that came meanwhile. Returns the first one that this object has ever taken, or 0.
  [[nodiscard]] int first() noexcept;

 private:
  sigset_t set_{};
  sigset_t before_{};
  int first_ = 0;
  static constexpr std::array ignored{SIGPIPE, SIGXFSZ, SIGTSTP, SIGTTIN, SIGTTOU};
  std::array<struct sigaction, ignored.size()> ignored_before_{};
};

}  // namespace softgrip::daemon
