#include "base/ending_signal.h"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstring>

namespace softgrip {
namespace {

std::atomic<int> noted{0};

/// Number that shells add to the number of a signal to report that this signal ended a process.
constexpr int shell_offset = 128;

}  // namespace

void note_ending_signal(int signal) noexcept {
  int none = 0;
  noted.compare_exchange_strong(none, signal);
}

int ending_signal() noexcept {
  return noted.load();
}

std::string name_of_signal(int signal) {
  const char* const name = ::sigabbrev_np(signal);
  return name != nullptr ? std::string("SIG") + name : "signal " + std::to_string(signal);
}

void end_by_signal(int signal) noexcept {
  std::fflush(nullptr);
  struct sigaction usual {};
  usual.sa_handler = SIG_DFL;
  sigaction(signal, &usual, nullptr);
  sigset_t only;
  sigemptyset(&only);
  sigaddset(&only, signal);
  pthread_sigmask(SIG_UNBLOCK, &only, nullptr);
  ::raise(signal);
  // The program reaches this line only if the default action of the signal does not end a process.
  ::_exit(shell_offset + signal);
}

}  // namespace softgrip
