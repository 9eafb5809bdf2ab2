#pragma once
// Real-time settings that are requested from the operating system; the `real_time` map of a rig file.

#include <cstddef>
#include <optional>
#include <vector>

namespace softgrip::rig {

struct RealTimeSettings {
  /// If true, the daemon does not start (exit code 1) if a setting below cannot be verified. If false, the
  /// daemon starts and reports the setting that failed, the reason and the consequence.
  bool required = false;
  /// SCHED_FIFO priority of the loop thread, 1 to 80; 0: ordinary scheduling. Kernel threads that the loop
  /// depends on have priorities above 80. The priority of the bus thread is 1 lower.
  int priority = 70;
  /// If true, the daemon calls mlockall() for current and future pages, does not trim the heap, and does not
  /// use mmap() for large blocks.
  bool lock_memory = true;
  /// Amount of stack that each real-time thread writes to before the first tick, so that its pages exist
  /// [bytes].
  std::size_t prefault_stack_bytes = 256 * 1024;
  /// Amount of heap that is allocated, written to and freed before the first tick [bytes].
  std::size_t prefault_heap_bytes = 8 * 1024 * 1024;
  /// Longest permitted wake-up latency from a sleep state of the processor, which is written to
  /// /dev/cpu_dma_latency [us]; if it is absent, nothing is written.
  std::optional<int> cpu_dma_latency_us = 0;
  /// Processors on which the loop and bus threads may run; empty: all.
  std::vector<int> cpus;
};

}  // namespace softgrip::rig
