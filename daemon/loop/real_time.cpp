#include "daemon/loop/real_time.h"

#include "base/enum_table.h"
#include "base/text.h"

#include <fcntl.h>
#include <linux/capability.h>
#include <malloc.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace softgrip::daemon {

namespace {

using Outcome = RealTimeStep::Outcome;

long page_bytes() {
  return sysconf(_SC_PAGESIZE);
}

/// Returns the number of page faults of the calling thread so far.
long page_faults() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_minflt + usage.ru_majflt;
}

void touch(volatile char* memory, std::size_t bytes) {
  for (std::size_t at = 0; at < bytes; at += static_cast<std::size_t>(page_bytes())) memory[at] = 1;
}

/// Returns the number of page faults that occur while a heap block of `bytes` bytes is allocated and written.
long faults_of_a_heap_block(std::size_t bytes) {
  const long before = page_faults();
  const std::unique_ptr<char[]> block(new char[bytes]);
  touch(block.get(), bytes);
  return page_faults() - before;
}

RealTimeStep prepare_heap(std::size_t bytes) {
  RealTimeStep step{
      .name = "heap",
      .outcome = Outcome::not_requested,
      .detail = "",
      .cost = "a memory allocation in a thread other than the control loop may cause page faults"};
  if (bytes == 0) return step;
  // Keeps freed blocks in the process, and takes large blocks from the heap instead of new mappings.
  const bool accepted = mallopt(M_TRIM_THRESHOLD, -1) == 1 && mallopt(M_MMAP_MAX, 0) == 1;
  faults_of_a_heap_block(bytes);
  const long faults = faults_of_a_heap_block(bytes);
  if (accepted && faults == 0) {
    step.outcome = Outcome::verified;
    step.detail =
        fmt::format("{} KiB of heap memory were accessed in advance and stay in the process", bytes / 1024);
  } else {
    step.outcome = Outcome::failed;
    step.detail = accepted ? fmt::format("{} page faults in a memory block that was accessed before", faults)
                           : "the allocator does not accept M_TRIM_THRESHOLD and M_MMAP_MAX";
  }
  return step;
}

/// Checks with a new page if MCL_FUTURE works. Returns an empty text if the new page is resident in memory,
/// otherwise the reason why MCL_FUTURE may not work.
std::string doubt_of_a_new_mapping() {
  const auto bytes = static_cast<std::size_t>(page_bytes());
  void* page = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (page == MAP_FAILED)
    return fmt::format("no new page can be mapped after the memory lock: {}", text_of_errno(errno));
  unsigned char resident = 0;
  const int error = mincore(page, bytes, &resident) == 0 ? 0 : errno;
  munmap(page, bytes);
  if (error != 0) {
    return fmt::format(
        "it is unknown if pages mapped after the memory lock are resident: {} (SystemCallFilter= of the unit "
        "must permit mincore)",
        text_of_errno(error));
  }
  return (resident & 1) != 0 ? "" : "a page mapped after the memory lock was not resident";
}

/// Returns true if the limit on locked memory (RLIMIT_MEMLOCK) does not apply to this process.
bool may_lock_without_limit() {
  rlimit limit{};
  getrlimit(RLIMIT_MEMLOCK, &limit);
  if (limit.rlim_cur == RLIM_INFINITY) return true;
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  std::array<__user_cap_data_struct, _LINUX_CAPABILITY_U32S_3> data{};
  if (syscall(SYS_capget, &header, data.data()) != 0) return false;
  return (data[CAP_TO_INDEX(CAP_IPC_LOCK)].effective & CAP_TO_MASK(CAP_IPC_LOCK)) != 0;
}

RealTimeStep lock_memory(bool wanted) {
  RealTimeStep step{
      .name = "memory lock",
      .outcome = Outcome::not_requested,
      .detail = "",
      .cost =
          "the first use of a memory page, or its return from swap, can stop the control loop for "
          "several milliseconds"};
  if (!wanted) return step;
  step.outcome = Outcome::failed;
  // If a limit on locked memory applies, mlockall() might succeed now, but the kernel could refuse memory
  // mappings after the call.
  const bool unlimited = may_lock_without_limit();
  if (!unlimited || mlockall(MCL_CURRENT | MCL_FUTURE) != 0) {
    const int error = unlimited ? errno : EPERM;
    rlimit limit{};
    getrlimit(RLIMIT_MEMLOCK, &limit);
    step.detail = fmt::format(
        "{}; the process may lock at most {} KiB (set LimitMEMLOCK=infinity in the unit, or grant "
        "CAP_IPC_LOCK)",
        text_of_errno(error), limit.rlim_cur / 1024);
  } else if (const std::string doubt = doubt_of_a_new_mapping(); !doubt.empty()) {
    step.detail = "the kernel accepted the memory lock, but " + doubt;
  } else {
    step.outcome = Outcome::verified;
    step.detail = "all memory pages are resident, including pages mapped after the memory lock";
  }
  return step;
}

RealTimeStep request_processor_latency(std::optional<int> latency_us, int& descriptor) {
  RealTimeStep step{.name = "processor latency",
                    .outcome = Outcome::not_requested,
                    .detail = "",
                    .cost = "an idle processor may need 10 to 200 us to wake the control loop"};
  if (!latency_us) return step;
  step.outcome = Outcome::failed;
  descriptor = open("/dev/cpu_dma_latency", O_RDWR | O_CLOEXEC);
  if (descriptor < 0) {
    step.detail = fmt::format(
        "/dev/cpu_dma_latency: {} (the udev rule of the package gives the group softgrip access to this "
        "device)",
        text_of_errno(errno));
    return step;
  }
  const std::int32_t wanted = *latency_us;
  std::int32_t in_force = -1;
  if (write(descriptor, &wanted, sizeof wanted) != sizeof wanted ||
      pread(descriptor, &in_force, sizeof in_force, 0) != sizeof in_force) {
    step.detail = fmt::format("/dev/cpu_dma_latency: {}", text_of_errno(errno));
  } else if (in_force > wanted) {
    step.detail = fmt::format("{} us requested, {} us in force", wanted, in_force);
  } else {
    step.outcome = Outcome::verified;
    step.detail = fmt::format("at most {} us", in_force);
  }
  return step;
}

RealTimeStep set_processors(const std::vector<int>& cpus, std::string_view who) {
  RealTimeStep step{.name = fmt::format("processors of {}", who),
                    .outcome = Outcome::not_requested,
                    .detail = "",
                    .cost =
                        "the kernel may move the thread between processors, which also run all other "
                        "programs of the computer"};
  if (cpus.empty()) return step;
  step.outcome = Outcome::failed;
  cpu_set_t wanted;
  CPU_ZERO(&wanted);
  for (const int cpu : cpus) {
    if (cpu >= 0 && cpu < CPU_SETSIZE) CPU_SET(static_cast<std::size_t>(cpu), &wanted);
  }
  if (sched_setaffinity(0, sizeof wanted, &wanted) != 0) {
    step.detail = fmt::format("{}: processors {} (this computer has {})", text_of_errno(errno),
                              fmt::join(cpus, ", "), sysconf(_SC_NPROCESSORS_ONLN));
    return step;
  }
  cpu_set_t in_force;
  CPU_ZERO(&in_force);
  if (sched_getaffinity(0, sizeof in_force, &in_force) == 0 && CPU_EQUAL(&wanted, &in_force)) {
    step.outcome = Outcome::verified;
    step.detail = fmt::format("{}", fmt::join(cpus, ", "));
  } else {
    step.detail =
        "the kernel applied other processors than requested (a cgroup's cpuset, or a processor that is "
        "offline)";
  }
  return step;
}

RealTimeStep set_scheduling(int priority, std::string_view who) {
  RealTimeStep step{.name = fmt::format("scheduling of {}", who),
                    .outcome = Outcome::not_requested,
                    .detail = "",
                    .cost = "other processes may delay the wake-up of the thread by several milliseconds"};
  // The timer slack matters for threads without SCHED_FIFO: by default, the kernel may delay each of their
  // wake-ups by 50 us to save power.
  prctl(PR_SET_TIMERSLACK, 1UL);
  if (priority <= 0) return step;
  step.outcome = Outcome::failed;
  sched_param parameters{};
  parameters.sched_priority = priority;
  if (sched_setscheduler(0, SCHED_FIFO, &parameters) != 0) {
    const int error = errno;
    rlimit limit{};
    getrlimit(RLIMIT_RTPRIO, &limit);
    step.detail = fmt::format(
        "{}; the highest permitted priority is {} (set LimitRTPRIO= in the unit, or grant CAP_SYS_NICE; a "
        "cpu cgroup without real-time budget also denies the priority)",
        text_of_errno(error), limit.rlim_cur);
    return step;
  }
  sched_param in_force{};
  const int policy = sched_getscheduler(0);
  if (sched_getparam(0, &in_force) == 0 && policy == SCHED_FIFO && in_force.sched_priority == priority) {
    step.outcome = Outcome::verified;
    step.detail = fmt::format("SCHED_FIFO {}", in_force.sched_priority);
  } else {
    step.detail = fmt::format(
        "the kernel accepted the request for SCHED_FIFO, but the thread has policy {} with priority {}",
        policy, in_force.sched_priority);
  }
  return step;
}

/// Writes to `bytes` bytes of the stack, so that the thread causes no page faults when it uses them. The
/// compiler must not inline the function, because the function writes to its own stack frame.
[[gnu::noinline]] long touch_stack(std::size_t bytes) {
  const long before = page_faults();
  auto* memory = static_cast<volatile char*>(__builtin_alloca(bytes));
  touch(memory, bytes);
  return page_faults() - before;
}

/// Returns the number of unused bytes of the calling thread's stack, minus a margin for the functions that
/// the thread calls next.
std::size_t stack_left() {
  constexpr std::size_t margin = 64 * 1024;
  pthread_attr_t attributes;
  if (pthread_getattr_np(pthread_self(), &attributes) != 0) return 0;
  void* lowest = nullptr;
  std::size_t size = 0;
  pthread_attr_getstack(&attributes, &lowest, &size);
  pthread_attr_destroy(&attributes);
  const char here = 0;
  const auto used_from = reinterpret_cast<std::uintptr_t>(&here);
  const std::uintptr_t end = reinterpret_cast<std::uintptr_t>(lowest) + margin;
  return used_from > end ? used_from - end : 0;
}

RealTimeStep prepare_stack(std::size_t bytes, std::string_view who) {
  RealTimeStep step{.name = fmt::format("stack of {}", who),
                    .outcome = Outcome::not_requested,
                    .detail = "",
                    .cost = "the first deep function call of the thread causes page faults"};
  if (bytes == 0) return step;
  if (const std::size_t left = stack_left(); bytes > left) {
    step.outcome = Outcome::failed;
    step.detail =
        fmt::format("{} KiB of stack were requested, but only {} KiB of the thread's stack are free",
                    bytes / 1024, left / 1024);
    return step;
  }
  touch_stack(bytes);
  const long faults = touch_stack(bytes);
  step.outcome = faults == 0 ? Outcome::verified : Outcome::failed;
  step.detail = faults == 0 ? fmt::format("{} KiB touched", bytes / 1024)
                            : fmt::format("{} page faults in a stack that was accessed before", faults);
  return step;
}

}  // namespace

std::string_view name_of(Outcome outcome) noexcept {
  static constexpr auto names = enum_names<Outcome>({{Outcome::verified, "verified"},
                                                     {Outcome::failed, "failed"},
                                                     {Outcome::not_requested, "not_requested"}});
  return names[outcome];
}

void RealTimeReport::append(const RealTimeReport& other) {
  steps_.insert(steps_.end(), other.steps_.begin(), other.steps_.end());
}

bool RealTimeReport::degraded() const noexcept {
  return std::any_of(steps_.begin(), steps_.end(),
                     [](const RealTimeStep& step) { return step.outcome == Outcome::failed; });
}

std::string RealTimeReport::format() const {
  std::string text;
  for (const RealTimeStep& step : steps_) {
    const bool requested = step.outcome != Outcome::not_requested;
    text += fmt::format("{}: {}{}{}\n", step.name, requested ? name_of(step.outcome) : "not requested",
                        step.detail.empty() ? "" : ", ", step.detail);
    if (step.outcome == Outcome::failed) text += fmt::format("  cost: {}\n", step.cost);
  }
  return text;
}

ProcessorLatencyRequest::ProcessorLatencyRequest(ProcessorLatencyRequest&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}

ProcessorLatencyRequest& ProcessorLatencyRequest::operator=(ProcessorLatencyRequest&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

ProcessorLatencyRequest::~ProcessorLatencyRequest() {
  if (descriptor_ >= 0) close(descriptor_);
}

ProcessorLatencyRequest prepare_process(const rig::RealTimeSettings& settings, RealTimeReport& report) {
  report.add(kernel_step());
  report.add(lock_memory(settings.lock_memory));
  report.add(prepare_heap(settings.prefault_heap_bytes));
  int descriptor = -1;
  report.add(request_processor_latency(settings.cpu_dma_latency_us, descriptor));
  return ProcessorLatencyRequest(descriptor);
}

void prepare_thread(const rig::RealTimeSettings& settings, int priority, std::string_view who,
                    RealTimeReport& report) {
  report.add(set_processors(settings.cpus, who));
  report.add(set_scheduling(priority, who));
  report.add(prepare_stack(settings.prefault_stack_bytes, who));
}

RealTimeStep kernel_step() {
  RealTimeStep step{.name = "kernel", .outcome = Outcome::not_requested, .detail = "", .cost = ""};
  utsname name{};
  uname(&name);
  // Some real-time kernels from 6.12 on have no /sys/kernel/realtime, but their version text contains
  // PREEMPT_RT.
  const bool real_time = std::string_view(name.version).find("PREEMPT_RT") != std::string_view::npos ||
                         access("/sys/kernel/realtime", F_OK) == 0;
  step.detail = fmt::format(
      "{}, {}", name.release,
      real_time
          ? "PREEMPT_RT"
          : "the kernel has no PREEMPT_RT, so under load a thread may wake up several milliseconds late");
  return step;
}

}  // namespace softgrip::daemon
