#include "daemon/service/signals.h"

#include <cstddef>

#include "base/exit_code.h"

namespace softgrip::daemon {

namespace {

/// All signals that end a process, except SIGKILL and the signals that report a defect of the process.
constexpr std::array ending{SIGINT,  SIGTERM,   SIGHUP,  SIGQUIT, SIGUSR1, SIGUSR2,  SIGALRM,
                            SIGXCPU, SIGVTALRM, SIGPROF, SIGIO,   SIGPWR,  SIGSTKFLT};

}  // namespace

Signals::Signals() noexcept {
  sigemptyset(&set_);
  for (const int signal : ending) sigaddset(&set_, signal);
  for (int signal = SIGRTMIN; signal <= SIGRTMAX; ++signal) sigaddset(&set_, signal);
  pthread_sigmask(SIG_BLOCK, &set_, &before_);
  struct sigaction ignore {};
  ignore.sa_handler = SIG_IGN;
  for (std::size_t i = 0; i < ignored.size(); ++i) sigaction(ignored[i], &ignore, &ignored_before_[i]);
}

Signals::~Signals() {
  for (std::size_t i = 0; i < ignored.size(); ++i) sigaction(ignored[i], &ignored_before_[i], nullptr);
  // After an orderly stop by a signal, all signals that arrive later are read and discarded. A signal that
  // was not read remains pending. In this case, an outer object of this class reads the signal, or the signal
  // ends the process.
  if (first_ != 0) (void)first();
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

int Signals::wait(Nanoseconds timeout) noexcept {
  const timespec time{timeout / ns_per_s, timeout % ns_per_s};
  const int signal = sigtimedwait(&set_, nullptr, &time);
  if (signal <= 0) return 0;
  if (first_ == 0) first_ = signal;
  note_ending_signal(signal);
  return signal;
}

int Signals::first() noexcept {
  while (wait(0) > 0) {
  }
  return first_;
}

}  // namespace softgrip::daemon
