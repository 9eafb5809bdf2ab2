#pragma once
// Real-time settings that are requested from the operating system; the `real_time` map of a rig file.

#include <cstddef>
#include <optional>
#include <vector>

namespace softgrip::rig {

struct RealTimeSettings {
  /// If true, the daemon refuses to start (exit code 1) if a setting below cannot be verified. If false, it
  /// starts and reports the setting that failed, the reason and the consequence.
  bool required = false;
  /// SCHED_FIFO priority of the loop thread, 1 to 80; 0: ordinary scheduling. Kernel threads that the loop
  /// depends on have priorities above 80. The priority of the bus thread is 1 lower.
  int priority = 70;
  /// Calls mlockall() for current and future pages. The heap is not trimmed and large blocks do not use
  /// mmap().
  bool lock_memory = true;
  /// Stack that each real-time thread writes to before the first tick [bytes].
  std::size_t prefault_stack_bytes = 256 * 1024;
  /// Heap that is written to and freed before the first tick [bytes].
  std::size_t prefault_heap_bytes = 8 * 1024 * 1024;
  /// Longest wake-up latency from a sleep state of the processor, written to /dev/cpu_dma_latency [us];
  /// absent: not set.
  std::optional<int> cpu_dma_latency_us = 0;
  /// Processors on which the loop and bus threads may run; empty: all.
  std::vector<int> cpus;
};

}  // namespace softgrip::rig
