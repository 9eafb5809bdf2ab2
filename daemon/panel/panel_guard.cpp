#include "daemon/panel/panel.h"

#include <csignal>
#include <cstddef>

namespace softgrip::daemon {

namespace {

constexpr std::array<int, 8> endings{SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGSYS, SIGQUIT, SIGXCPU};

std::atomic<Panel*> guarded{nullptr};
std::array<struct sigaction, endings.size()> before;

extern "C" void softgrip_drop_panel(int signal) {
  // The driver library writes a line with one system call, without locks and without allocation. The call is
  // therefore safe in a signal handler.
  if (Panel* const panel = guarded.exchange(nullptr)) panel->drop();
  // SA_RESETHAND has restored the default action of the signal, so the raised signal ends the process.
  ::raise(signal);
}

}  // namespace

PanelGuard::PanelGuard(Panel& panel) noexcept {
  guarded.store(&panel);
  struct sigaction action {};
  action.sa_handler = softgrip_drop_panel;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_NODEFER);
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < endings.size(); ++i) ::sigaction(endings[i], &action, &before[i]);
}

PanelGuard::~PanelGuard() {
  for (std::size_t i = 0; i < endings.size(); ++i) ::sigaction(endings[i], &before[i], nullptr);
  guarded.store(nullptr);
}

}  // namespace softgrip::daemon
