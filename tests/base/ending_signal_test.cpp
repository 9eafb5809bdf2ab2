#include "base/ending_signal.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <functional>
#include <string>

namespace softgrip::ending_signal_test {
namespace {

/// Runs `body` in a child process and returns the wait status of the child.
int status_of(const std::function<void()>& body) {
  const pid_t child = ::fork();
  if (child == 0) {
    body();
    ::_exit(0);
  }
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  return status;
}

TEST(EndingSignal, TheFirstOneIsKept) {
  const int status = status_of([] {
    if (ending_signal() != 0) ::_exit(1);
    note_ending_signal(SIGHUP);
    note_ending_signal(SIGINT);
    if (ending_signal() != SIGHUP) ::_exit(2);
  });
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
}

TEST(EndingSignal, EndsTheProcessEvenWhereItIsBlockedAndIgnored) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGRTMIN}) {
    const int status = status_of([signal] {
      sigset_t all;
      sigfillset(&all);
      pthread_sigmask(SIG_SETMASK, &all, nullptr);
      std::signal(signal, SIG_IGN);
      end_by_signal(signal);
    });
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal) << signal << ": " << status;
  }
}

TEST(EndingSignal, HasAName) {
  EXPECT_EQ(name_of_signal(SIGINT), "SIGINT");
  EXPECT_EQ(name_of_signal(SIGHUP), "SIGHUP");
  EXPECT_EQ(name_of_signal(SIGRTMIN), "signal " + std::to_string(SIGRTMIN));
}

TEST(EndingSignal, ASignalThatDoesNotEndAProcessIsAnExitCode) {
  const int status = status_of([] { end_by_signal(SIGURG); });
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 128 + SIGURG) << status;
}

}  // namespace
}  // namespace softgrip::ending_signal_test
