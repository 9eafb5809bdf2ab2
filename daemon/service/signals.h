#pragma once
// Signals as something to wait for, not as interruptions.

#include <csignal>
#include <ctime>

#include "base/grid.h"

namespace softgrip::daemon {

/// As long as it lives, SIGINT, SIGTERM and SIGHUP are blocked in the calling thread and in those it starts,
/// and SIGPIPE and SIGXFSZ are ignored: a peer that is gone and a file that is too large are errors of the
/// call.
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
  struct sigaction pipe_before_ {};
  struct sigaction size_before_ {};
};

}  // namespace softgrip::daemon
