#include "daemon/service/signals.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>

#include "base/exit_code.h"

namespace softgrip::daemon::signals_test {
namespace {

/// Runs `body` in a child process, because signals concern a whole process. Returns the status of the child
/// as waitpid() reports it.
int status_of(const std::function<bool()>& body) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(body() ? 0 : 1);
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  return status;
}

TEST(Signals, TheFirstSignalIsReportedAsTheEndingSignal) {
  EXPECT_EQ(status_of([] {
              Signals signals;
              if (signals.first() != 0) return false;
              ::raise(SIGTERM);
              if (signals.wait(0) != SIGTERM) return false;
              ::raise(SIGINT);
              return signals.first() == SIGTERM && ending_signal() == SIGTERM && signals.wait(0) == 0;
            }),
            0);
}

TEST(Signals, AfterAHandledSignalOthersDoNotEndTheProcess) {
  EXPECT_EQ(status_of([] {
              {
                Signals signals;
                ::raise(SIGINT);
                (void)signals.wait(0);
                ::raise(SIGINT);
                ::raise(SIGTERM);
              }
              return true;
            }),
            0);
}

TEST(Signals, AnUnhandledSignalIsPassedToTheOuterObject) {
  EXPECT_EQ(status_of([] {
              Signals outer;
              {
                const Signals inner;
                ::raise(SIGHUP);
              }
              return outer.wait(0) == SIGHUP;
            }),
            0);
}

TEST(Signals, AnUnhandledSignalEndsTheProcess) {
  const int status = status_of([] {
    {
      const Signals signals;
      ::raise(SIGTERM);
    }
    return true;
  });
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGTERM) << status;
}

}  // namespace
}  // namespace softgrip::daemon::signals_test
