#pragma once
// Switches the enable output of the panel off if the process crashes.

namespace softgrip::daemon {

class Panel;

/// While this object exists, the signals of a crash (SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGSYS,
/// SIGQUIT, SIGXCPU) switch the panel's enable output off before they end the process. A program cannot
/// handle SIGKILL. Only one object may exist at a time.
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
