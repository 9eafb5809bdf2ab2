#pragma once
// Signals as something to wait for, not as interruptions.

#include <array>
#include <csignal>
#include <ctime>

#include "base/grid.h"

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

  /// The signal that came, or 0 after `timeout`.
  [[nodiscard]] int wait(Nanoseconds timeout) noexcept;

 private:
  sigset_t set_{};
  sigset_t before_{};
  static constexpr std::array ignored{SIGPIPE, SIGXFSZ, SIGTSTP, SIGTTIN, SIGTTOU};
  std::array<struct sigaction, ignored.size()> ignored_before_{};
};

}  // namespace softgrip::daemon
