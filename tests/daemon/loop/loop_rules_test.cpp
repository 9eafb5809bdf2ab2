// Tests that the thread of the control loop allocates no memory and causes no page faults. The only system
// calls of this thread are those that read the clock and sleep.

#include <gtest/gtest.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <malloc.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <thread>

#include "daemon/loop/real_time.h"
#include "daemon/service/daemon_parts.h"
#include "tests/daemon/rig_under_test.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SOFTGRIP_SANITIZED 1
#else
#define SOFTGRIP_SANITIZED 0
#endif

namespace {

thread_local bool armed = false;
std::atomic<std::uint64_t> allocations{0};

}  // namespace

#if !SOFTGRIP_SANITIZED
namespace {

void count_allocation() noexcept {
  if (armed) allocations.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace

// The test replaces the memory functions of the C library by functions that count their calls. operator new
// calls the memory functions of the C library, so its calls are counted as well.
extern "C" {
// NOLINTBEGIN(bugprone-reserved-identifier): these names are given by the C library
void* __libc_malloc(size_t);
void* __libc_calloc(size_t, size_t);
void* __libc_realloc(void*, size_t);
void __libc_free(void*);
void* __libc_memalign(size_t, size_t);
// NOLINTEND(bugprone-reserved-identifier)

void* malloc(size_t size) {
  count_allocation();
  return __libc_malloc(size);
}
void* calloc(size_t count, size_t size) {
  count_allocation();
  return __libc_calloc(count, size);
}
void* realloc(void* old, size_t size) {
  count_allocation();
  return __libc_realloc(old, size);
}
void* memalign(size_t alignment, size_t size) {
  count_allocation();
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(size_t alignment, size_t size) {
  count_allocation();
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** memory, size_t alignment, size_t size) {
  count_allocation();
  *memory = __libc_memalign(alignment, size);
  return *memory == nullptr ? ENOMEM : 0;
}
void free(void* memory) {
  if (memory != nullptr) count_allocation();
  __libc_free(memory);
}
}
#endif

namespace softgrip::daemon::loop_rules_test {
namespace {

using control::Request;
using control::State;

std::unique_ptr<DaemonParts> make_parts(bool virtual_time) {
  rig::RigFile rig = testing::example_rig("rig.yaml");
  DaemonOptions options;
  options.virtual_time = virtual_time;
  return std::make_unique<DaemonParts>(std::move(rig), std::move(options));
}

/// Runs the loop in virtual time. All other components of the daemon run between two ticks. Allocations are
/// counted only during a tick of the loop.
class WatchedTicks {
 public:
  explicit WatchedTicks(DaemonParts& parts) : parts_(parts), due_(parts.origin) {}

  /// Runs ticks until the state is reached or 60 s have passed. Returns true if the state was reached.
  bool until(State state) {
    for (const Nanoseconds end = due_ + 60 * ns_per_s; due_ < end;) {
      tick();
      if (parts_.service.snapshot().state == state) return true;
    }
    return false;
  }
  void tick() {
    parts_.virtual_clock.set(due_);
    armed = true;
    parts_.loop.tick(due_);
    armed = false;
    parts_.virtual_clock.set(due_ + parts_.bus_offset());
    parts_.bus.step(due_ + parts_.bus_offset());
    parts_.service.pump();
    parts_.recorder.drain();
    due_ += parts_.period();
  }

 private:
  DaemonParts& parts_;
  Nanoseconds due_;
};

TEST(LoopRules, TheHookCountsAllocationsAndReleases) {
  if (SOFTGRIP_SANITIZED) GTEST_SKIP() << "with sanitizers, the program uses a different allocator";
  allocations.store(0);
  armed = true;
  // The volatile pointer prevents the compiler from removing the calls of malloc() and free().
  void* volatile memory = std::malloc(16);
  std::free(memory);
  armed = false;
  EXPECT_EQ(allocations.load(), 2U);
}

TEST(LoopRules, NoTickAllocates) {
  if (SOFTGRIP_SANITIZED) GTEST_SKIP() << "with sanitizers, the program uses a different allocator";
  const auto parts = make_parts(true);
  parts->rig.recorder.mode = rig::RecorderSettings::Mode::off;
  const auto sequence = testing::example_sequence(parts->rig, "pick_stone.yaml");
  WatchedTicks ticks(*parts);
  allocations.store(0);
  ASSERT_TRUE(ticks.until(State::idle));
  parts->service.submit(Request::Kind::start, sequence);
  ASSERT_TRUE(ticks.until(State::running));
  ASSERT_TRUE(ticks.until(State::idle)) << "the sequence runs to its end";
  parts->service.submit(Request::Kind::start, sequence);
  ASSERT_TRUE(ticks.until(State::running));
  parts->service.submit(Request::Kind::vent);
  ASSERT_TRUE(ticks.until(State::stopping));
  ASSERT_TRUE(ticks.until(State::idle));
  parts->shared.inputs.emergency_stop.store(true);
  ASSERT_TRUE(ticks.until(State::faulted));
  parts->shared.inputs.emergency_stop.store(false);
  ticks.tick();
  parts->service.submit(Request::Kind::acknowledge);
  ASSERT_TRUE(ticks.until(State::idle));
  EXPECT_GT(parts->loop_statistics.ticks.value(), 2000U);
  EXPECT_EQ(allocations.load(), 0U);
}

/// Functions that run before and after the loop. A test sets them.
struct Around {
  std::function<void()> before = [] {};  ///< called in the loop's thread when the thread has been prepared
  std::function<void()> after = [] {};   ///< called in the loop's thread after the loop has ended
  std::function<void()> last = [] {};    ///< called in the loop's thread after the loop has announced its end
  std::function<void()> ended = [] {};   ///< called in the test's thread after the loop has announced its end
};

/// Runs the real control loop and the real bus thread for `duration`. As in the daemon, each has its own
/// thread.
void run_threads(DaemonParts& parts, Nanoseconds duration, const Around& around) {
  RealTimeReport report;
  const ProcessorLatencyRequest latency = prepare_process(parts.rig.real_time, report);
  parts.bus.open();
  const Nanoseconds start = parts.clock.now() + ns_per_s / 50;
  std::atomic<bool> loop_ended{false};
  std::thread bus([&] {
    parts.bus.run(PeriodicSchedule(start + parts.bus_offset(), parts.period()), std::chrono::seconds(1));
  });
  std::thread loop([&] {
    RealTimeReport ignored;
    prepare_thread(parts.rig.real_time, parts.rig.real_time.priority, "the loop", ignored);
    around.before();
    parts.loop.run(PeriodicSchedule(start, parts.period()));
    around.after();
    loop_ended.store(true);
    around.last();
  });
  const Nanoseconds end = start + duration;
  bool asked = false;
  const auto sequence = testing::example_sequence(parts.rig, "pick_stone.yaml");
  while (parts.clock.now() < end) {
    parts.service.pump();
    if (!asked && parts.service.snapshot().state == State::idle) {
      parts.service.submit(Request::Kind::start, sequence);
      asked = true;
    }
    sleep_until(parts.clock.now() + ns_per_s / 100);
  }
  parts.shared.shutdown_requested.store(true);
  bus.join();
  while (!loop_ended.load()) sleep_until(parts.clock.now() + ns_per_s / 1000);
  around.ended();
  loop.join();
}

TEST(LoopRules, NoTickCausesPageFaults) {
  if (SOFTGRIP_SANITIZED) GTEST_SKIP() << "sanitizers cause additional page faults";
  const auto parts = make_parts(false);
  rusage before{};
  rusage after{};
  Around around;
  around.before = [&] { getrusage(RUSAGE_THREAD, &before); };
  around.after = [&] { getrusage(RUSAGE_THREAD, &after); };
  run_threads(*parts, 3 * ns_per_s, around);
  EXPECT_GT(parts->loop_statistics.ticks.value(), 100U);
  // Locked memory causes no page faults. If the process has no permission to lock memory, the kernel may
  // remove a page from memory, and the next access to this page causes a page fault.
  EXPECT_EQ(after.ru_majflt, before.ru_majflt);
  EXPECT_EQ(after.ru_minflt, before.ru_minflt);
}

std::atomic<long> forbidden_call{-1};

void on_forbidden_call(int, siginfo_t* info, void*) {
  long expected = -1;
  forbidden_call.compare_exchange_strong(expected, info->si_syscall);
}

/// Restricts the calling thread to three kinds of system calls: sleep, read the clock, and return from a
/// signal handler. Any other system call fails and is recorded. The restriction cannot be removed, so the
/// test must call this function in a child process.
void allow_only_clock_and_sleep() {
  const std::array<sock_filter, 8> program{{
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_clock_nanosleep, 4, 0),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_clock_gettime, 3, 0),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_restart_syscall, 2, 0),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_rt_sigreturn, 1, 0),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
  }};
  const sock_fprog filter{static_cast<unsigned short>(program.size()),
                          const_cast<sock_filter*>(program.data())};
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 ||
      prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter) != 0) {
    forbidden_call.store(-2);
  }
}

constexpr int clean = 0;
constexpr int no_filter = 100;
constexpr int no_ticks = 101;
constexpr int forbidden = 102;

/// Runs `body` in a child process. Returns the exit code of the child: `clean`, or a code for the failure.
int in_child(const std::function<int()>& body) {
  const pid_t child = fork();
  if (child == 0) {
    struct sigaction action {};
    action.sa_sigaction = on_forbidden_call;
    action.sa_flags = SA_SIGINFO;
    sigaction(SIGSYS, &action, nullptr);
    _exit(body());
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

int verdict() {
  const long call = forbidden_call.load();
  if (call == -1) return clean;
  if (call == -2) return no_filter;
  std::fprintf(stderr, "system call %ld in the thread of the control loop\n", call);
  return forbidden;
}

TEST(LoopRules, TheFilterDetectsAForbiddenSystemCall) {
  if (SOFTGRIP_SANITIZED) GTEST_SKIP() << "sanitizers make additional system calls";
  const auto body = [] {
    std::atomic<bool> done{false};
    std::thread thread([&done] {
      allow_only_clock_and_sleep();
      sleep_until(1);
      syscall(SYS_getppid);
      done.store(true);
      for (;;) sleep_until(INT64_MAX);
    });
    while (!done.load()) sleep_until(MonotonicClock().now() + ns_per_s / 1000);
    _exit(verdict());
    return clean;
  };
  EXPECT_EQ(in_child(body), forbidden);
}

TEST(LoopRules, TicksUseOnlyClockAndSleepSystemCalls) {
  if (SOFTGRIP_SANITIZED) GTEST_SKIP() << "sanitizers make additional system calls";
  const auto body = [] {
    const auto parts = make_parts(false);
    Around around;
    around.before = allow_only_clock_and_sleep;
    // Do not end this thread, because the end of a thread needs system calls that are not allowed.
    around.last = [] {
      for (;;) sleep_until(INT64_MAX);
    };
    around.ended = [&parts] { _exit(parts->loop_statistics.ticks.value() < 100 ? no_ticks : verdict()); };
    run_threads(*parts, 3 * ns_per_s, around);
    return clean;
  };
  EXPECT_EQ(in_child(body), clean);
}

}  // namespace
}  // namespace softgrip::daemon::loop_rules_test
