#include "base/exit_code.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <functional>

#include "base/descriptor.h"

namespace softgrip::exit_code_test {
namespace {

/// Redirects the standard output to the file `path` and prints a line. Returns the exit code of
/// with_output_checked(). Call this function in a child process, because the redirection remains.
int end_of_a_program_that_prints_to(const char* path, ExitCode code) {
  const Descriptor target(::open(path, O_WRONLY | O_CLOEXEC));
  ::dup2(target.get(), STDOUT_FILENO);
  std::printf("a result\n");
  return static_cast<int>(with_output_checked(code, "test"));
}

TEST(StandardOutputDeathTest, ASuccessfulWriteKeepsTheExitCodeDone) {
  EXPECT_EXIT(::_exit(end_of_a_program_that_prints_to("/dev/null", ExitCode::done)),
              testing::ExitedWithCode(0), "");
}

TEST(StandardOutputDeathTest, AFailedWriteGivesTheExitCodeIoError) {
  EXPECT_EXIT(::_exit(end_of_a_program_that_prints_to("/dev/full", ExitCode::done)),
              testing::ExitedWithCode(4),
              "test: cannot write to the standard output: No space left on device");
}

TEST(StandardOutputDeathTest, AFailedWriteKeepsAnEarlierFailureCode) {
  EXPECT_EXIT(::_exit(end_of_a_program_that_prints_to("/dev/full", ExitCode::not_acceptable)),
              testing::ExitedWithCode(6), "standard output");
}

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

TEST(EndingSignal, TheFirstNotedSignalIsKept) {
  const int status = status_of([] {
    if (ending_signal() != 0) ::_exit(1);
    note_ending_signal(SIGHUP);
    note_ending_signal(SIGINT);
    if (ending_signal() != SIGHUP) ::_exit(2);
  });
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
}

TEST(EndingSignal, EndsTheProcessDespiteBlockedAndIgnoredSignals) {
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

TEST(EndingSignal, ReturnsTheNameOfASignal) {
  EXPECT_EQ(name_of_signal(SIGINT), "SIGINT");
  EXPECT_EQ(name_of_signal(SIGHUP), "SIGHUP");
  EXPECT_EQ(name_of_signal(SIGRTMIN), "signal " + std::to_string(SIGRTMIN));
}

TEST(EndingSignal, ANonFatalSignalGivesTheExitCode128PlusSignal) {
  const int status = status_of([] { end_by_signal(SIGURG); });
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 128 + SIGURG) << status;
}

}  // namespace
}  // namespace softgrip::exit_code_test
