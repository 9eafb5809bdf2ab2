#pragma once
// The enable output on the way out of a process that crashes.

namespace softgrip::daemon {

class Panel;

/// As long as it lives, the signals by which a crash ends the process (SIGSEGV, SIGBUS, SIGFPE, SIGILL,
/// SIGABRT, SIGSYS, SIGQUIT, SIGXCPU) drop the panel's enable output before they take their course. Nothing
/// helps against SIGKILL. At most one lives at a time.
class PanelGuard {
 public:
  explicit PanelGuard(Panel& panel) noexcept;
  PanelGuard(const PanelGuard&) = delete;
  PanelGuard& operator=(const PanelGuard&) = delete;
  PanelGuard(PanelGuard&&) = delete;
  PanelGuard& operator=(PanelGuard&&) = delete;
  ~PanelGuard();
};

}  // namespace softgrip::daemon
