#include "daemon/loop/real_time.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <thread>

#include "daemon/loop/thread.h"

namespace softgrip::daemon::real_time_test {
namespace {

using Outcome = RealTimeStep::Outcome;

const RealTimeStep* find(const RealTimeReport& report, std::string_view name) {
  const auto& steps = report.steps();
  const auto found =
      std::find_if(steps.begin(), steps.end(), [&](const auto& step) { return step.name == name; });
  return found == steps.end() ? nullptr : &*found;
}

/// Runs prepare_thread() in a new thread and then calls `look` in the same thread.
RealTimeReport prepared(const rig::RealTimeSettings& settings, int priority,
                        const std::function<void()>& look) {
  RealTimeReport report;
  std::thread thread([&] {
    prepare_thread(settings, priority, "the loop", report);
    look();
  });
  thread.join();
  return report;
}

TEST(RealTime, ReportsVerifiedOnlyForSettingsInForce) {
  rig::RealTimeSettings settings;
  settings.cpus = {0};
  int policy = -1;
  cpu_set_t cpus;
  CPU_ZERO(&cpus);
  const RealTimeReport report = prepared(settings, 20, [&] {
    policy = sched_getscheduler(0);
    sched_getaffinity(0, sizeof cpus, &cpus);
  });
  const RealTimeStep* scheduling = find(report, "scheduling of the loop");
  ASSERT_NE(scheduling, nullptr);
  EXPECT_EQ(scheduling->outcome == Outcome::verified, policy == SCHED_FIFO) << scheduling->detail;
  const RealTimeStep* processors = find(report, "processors of the loop");
  ASSERT_NE(processors, nullptr);
  EXPECT_EQ(processors->outcome == Outcome::verified, CPU_COUNT(&cpus) == 1 && CPU_ISSET(0, &cpus));
}

TEST(RealTime, SettingsNotRequestedAreNeverReportedAsFailed) {
  rig::RealTimeSettings settings;
  settings.lock_memory = false;
  settings.prefault_heap_bytes = 0;
  settings.prefault_stack_bytes = 0;
  settings.cpu_dma_latency_us.reset();
  RealTimeReport report;
  const ProcessorLatencyRequest latency = prepare_process(settings, report);
  report.append(prepared(settings, 0, [] {}));
  EXPECT_FALSE(report.degraded());
  for (const RealTimeStep& step : report.steps())
    EXPECT_EQ(step.outcome, Outcome::not_requested) << step.name;
}

TEST(RealTime, AMissingProcessorIsAFailureWithTheCost) {
  rig::RealTimeSettings settings;
  settings.cpus = {1023};
  const RealTimeReport report = prepared(settings, 0, [] {});
  EXPECT_TRUE(report.degraded());
  const RealTimeStep* step = find(report, "processors of the loop");
  ASSERT_NE(step, nullptr);
  EXPECT_EQ(step->outcome, Outcome::failed);
  EXPECT_NE(report.format().find("cost: " + step->cost), std::string::npos);
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool sanitized = true;  // with a sanitizer, mlockall() has no effect
#else
constexpr bool sanitized = false;
#endif

/// The test runs in a child process that drops its privileges.
TEST(RealTime, WithoutPrivilegesEachFailureNamesTheLimit) {
  if (sanitized) GTEST_SKIP() << "sanitizers intercept the locking of memory";
  const pid_t child = fork();
  if (child == 0) {
    const rlimit none{0, 0};
    setrlimit(RLIMIT_RTPRIO, &none);
    setrlimit(RLIMIT_MEMLOCK, &none);
    if (getuid() == 0 && setuid(65534) != 0) _exit(2);
    RealTimeReport report;
    [[maybe_unused]] const ProcessorLatencyRequest latency = prepare_process({}, report);
    prepare_thread({}, 70, "the loop", report);
    const RealTimeStep* scheduling = find(report, "scheduling of the loop");
    const RealTimeStep* memory = find(report, "memory lock");
    const bool said = scheduling->outcome == Outcome::failed &&
                      scheduling->detail.find("LimitRTPRIO") != std::string::npos &&
                      memory->outcome == Outcome::failed &&
                      memory->detail.find("LimitMEMLOCK") != std::string::npos;
    _exit(said && report.degraded() ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST(RealTime, ReportsThePrefaultedStackAsVerified) {
#ifdef __SANITIZE_THREAD__
  GTEST_SKIP() << "ThreadSanitizer causes additional page faults for every touched page";
#endif
  rig::RealTimeSettings settings;
  settings.prefault_stack_bytes = 512 * 1024;
  RealTimeReport report;
  Thread thread(
      {.name = "prefault", .stack_bytes = 2 * 1024 * 1024},
      [&] { prepare_thread(settings, 0, "the loop", report); }, [](const std::string&) {});
  thread.join();
  ASSERT_NE(find(report, "stack of the loop"), nullptr);
  EXPECT_EQ(find(report, "stack of the loop")->outcome, Outcome::verified);
}

TEST(RealTime, AStackThatIsTooSmallIsAFailureAndNoCrash) {
  rig::RealTimeSettings settings;
  settings.prefault_stack_bytes = 4 * 1024 * 1024;
  RealTimeReport report;
  Thread thread(
      {.name = "prefault", .stack_bytes = 1024 * 1024},
      [&] { prepare_thread(settings, 0, "the loop", report); }, [](const std::string&) {});
  thread.join();
  ASSERT_NE(find(report, "stack of the loop"), nullptr);
  EXPECT_EQ(find(report, "stack of the loop")->outcome, Outcome::failed);
}

TEST(Thread, AnExceptionInAThreadIsReported) {
  std::string told;
  Thread thread(
      {.name = "throws"}, [] { throw std::runtime_error("on purpose"); },
      [&told](const std::string& what) { told = what; });
  thread.join();
  EXPECT_EQ(told, "on purpose");
}

TEST(Thread, HasTheRequestedStackAndATruncatedName) {
  std::size_t stack_bytes = 0;
  char name[16] = "";
  Thread thread(
      {.name = "a-name-that-is-too-long", .stack_bytes = 512 * 1024},
      [&] {
        pthread_attr_t attributes;
        pthread_getattr_np(pthread_self(), &attributes);
        pthread_attr_getstacksize(&attributes, &stack_bytes);
        pthread_attr_destroy(&attributes);
        pthread_getname_np(pthread_self(), name, sizeof name);
      },
      [](const std::string&) {});
  thread.join();
  // Allow up to twice the requested stack size, because the C library may reuse the stack of a thread that
  // has ended.
  EXPECT_GE(stack_bytes, 512U * 1024);
  EXPECT_LE(stack_bytes, 1024U * 1024);
  EXPECT_STREQ(name, "a-name-that-is-");
}

}  // namespace
}  // namespace softgrip::daemon::real_time_test
