#include "base/exit_code.h"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

#include "base/text.h"

namespace softgrip {
namespace {

std::atomic<int> noted{0};

/// Number that shells add to the number of a signal to report that this signal ended a process.
constexpr int shell_offset = 128;

}  // namespace

ExitCode with_output_checked(ExitCode code, const char* program) noexcept {
  errno = 0;
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
  // stdout stores that an earlier write failed, but not the reason of the failure.
  const char* const reason =
      errno != 0 ? text_of_errno(errno) : "an earlier write failed, so a part of the output is lost";
  std::fprintf(stderr, "%s: cannot write to the standard output: %s\n", program, reason);
  return code == ExitCode::done ? ExitCode::io : code;
}

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
