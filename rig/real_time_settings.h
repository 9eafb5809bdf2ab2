#pragma once
// What the operating system is asked for so that the loop wakes in time; the `real_time` map of a rig file.

#include <cstddef>
#include <optional>
#include <vector>

namespace softgrip::rig {

struct RealTimeSettings {
  /// Refuse to start (exit code 1) if any step asked for below cannot be verified. With false the daemon
  /// starts, says which step failed, why, and what it costs.
  bool required = false;
  /// SCHED_FIFO priority of the loop thread, 1 to 80 (above that live kernel threads that the loop itself
  /// depends on); 0: ordinary scheduling. The bus thread runs one below.
  int priority = 70;
  /// mlockall(current and future), no trimming of the heap, no mmap for large blocks.
  bool lock_memory = true;
  /// Stack touched before the first tick, of every real-time thread [bytes].
  std::size_t prefault_stack_bytes = 256 * 1024;
  /// Heap touched and given back to the allocator before the first tick [bytes].
  std::size_t prefault_heap_bytes = 8 * 1024 * 1024;
  /// Longest wake-up from a processor's sleep state, written to /dev/cpu_dma_latency [us]; absent: not asked.
  std::optional<int> cpu_dma_latency_us = 0;
  /// Processors the loop and bus threads may run on; empty: any.
  std::vector<int> cpus;
};

}  // namespace softgrip::rig
