#pragma once
// The settings in the `real_time` map of a rig file, which the daemon requests from the operating system.

#include <cstddef>
#include <optional>
#include <vector>

namespace softgrip::rig {

struct RealTimeSettings {
  /// If true and a setting below cannot be verified, the daemon does not start (exit code 1). If false, the
  /// daemon starts in any case. It reports each setting that failed, with the reason and the consequence.
  bool required = false;
  /// SCHED_FIFO priority of the loop thread, 1 to 80; 0: no real-time scheduling. The kernel threads on which
  /// the loop depends have priorities above 80. The priority of the bus thread is 1 lower.
  int priority = 70;
  /// If true, the daemon locks its present and future pages with mlockall(). It also does not return heap
  /// memory to the kernel, and does not use mmap() for large blocks.
  bool lock_memory = true;
  /// Number of bytes of its stack that each real-time thread writes before the first tick, so that the pages
  /// are resident in memory.
  std::size_t prefault_stack_bytes = 256 * 1024;
  /// Number of bytes of the heap that are allocated, written and freed before the first tick.
  std::size_t prefault_heap_bytes = 8 * 1024 * 1024;
  /// Longest permitted time in which a processor wakes up from a sleep state [us]. The value is written to
  /// /dev/cpu_dma_latency; if it is empty, nothing is written.
  std::optional<int> cpu_dma_latency_us = 0;
  /// Processors on which the threads of loop and bus may run; empty: all processors.
  std::vector<int> cpus;
};

}  // namespace softgrip::rig
