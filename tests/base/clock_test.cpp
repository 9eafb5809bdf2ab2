#include "base/clock.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <ctime>

#include "base/periodic_schedule.h"

namespace softgrip::clock_test {
namespace {

constexpr int no_such_namespace = 77;

/// Runs `body` in a time namespace in which the machine has slept for a day since boot. Returns the exit code
/// of `body`.
int after_a_day_asleep(int (*body)()) {
  std::fflush(nullptr);
  const pid_t outer = fork();
  if (outer == 0) {
    if (unshare(CLONE_NEWTIME) != 0) _exit(no_such_namespace);
    const int offsets = open("/proc/self/timens_offsets", O_WRONLY | O_CLOEXEC);
    const std::string text = "boottime 86400 0\n";
    if (offsets < 0 || write(offsets, text.data(), text.size()) < 0) _exit(no_such_namespace);
    close(offsets);
    // unshare() moves the child processes of this process, but not this process, to the new time namespace.
    // The test therefore runs in a child process.
    const pid_t inner = fork();
    if (inner == 0) _exit(body());
    int status = 0;
    waitpid(inner, &status, 0);
    _exit(WIFEXITED(status) ? WEXITSTATUS(status) : 99);
  }
  int status = 0;
  waitpid(outer, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 99;
}

Nanoseconds monotonic() {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return time.tv_sec * ns_per_s + time.tv_nsec;
}

TEST(MonotonicClock, CountsTheTimeWhileTheMachineIsSuspended) {
  const int code = after_a_day_asleep([] {
    const MonotonicClock clock;
    constexpr Nanoseconds day = 86'400 * ns_per_s;
    const Nanoseconds ahead = clock.now() - monotonic();
    if (ahead < day - ns_per_s || ahead > day + ns_per_s) return 1;
    if (time_asleep() != day) return 2;
    alarm(10);  // With CLOCK_MONOTONIC, sleep_until() would sleep for one day.
    const Nanoseconds due = clock.now() + ns_per_s / 50;
    clock.sleep_until(due);
    return clock.now() >= due ? 0 : 3;
  });
  if (code == no_such_namespace)
    GTEST_SKIP() << "the user of this test is not allowed to create a time namespace";
  EXPECT_EQ(code, 0);
}

TEST(MonotonicClock, EqualsKernelMonotonicTimePlusSuspendTime) {
  const Nanoseconds slept = time_asleep();
  const Nanoseconds before = monotonic();
  const Nanoseconds now = MonotonicClock().now();
  EXPECT_GE(now, before + slept - ns_per_s / 1000);
  EXPECT_LE(now, monotonic() + slept + ns_per_s / 1000);
}

TEST(WallClock, UtcTextsSortInTimeOrder) {
  constexpr Nanoseconds moment = 1'763'610'372'045'678'901;
  EXPECT_EQ(utc_text(moment), "2025-11-20T03:46:12Z");
  EXPECT_EQ(utc_text(moment, 3), "2025-11-20T03:46:12.045Z");
  EXPECT_EQ(utc_text(moment, 9), "2025-11-20T03:46:12.045678901Z");
  EXPECT_LT(utc_text(moment, 3), utc_text(moment + ns_per_s / 500, 3));
}

TEST(WallClock, ConvertsBootTimeToWallTime) {
  timespec now{};
  clock_gettime(CLOCK_BOOTTIME, &now);
  const Nanoseconds moment = now.tv_sec * ns_per_s + now.tv_nsec;
  EXPECT_NEAR(seconds(wall_time_now() - wall_time(moment - 60 * ns_per_s)), 60, 5);
}

}  // namespace
}  // namespace softgrip::clock_test
