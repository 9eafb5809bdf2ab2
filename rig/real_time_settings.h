#pragma once
// The settings in the `real_time` map of a rig file, which the daemon requests from the operating system.

#include <cstddef>
#include <optional>
#include <vector>

namespace softgrip::rig {

/// The map `real_time` of a rig file. rig/rig_keys.cpp declares the meaning and the range of each member.
struct RealTimeSettings {
  bool required = false;
  int priority = 70;
  /// If true, the daemon locks its present and future pages with mlockall(). It also does not return heap
  /// memory to the kernel, and does not use mmap() for large blocks.
  bool lock_memory = true;
  std::size_t prefault_stack_bytes = 256 * 1024;
  std::size_t prefault_heap_bytes = 8 * 1024 * 1024;
  /// The value is written to /dev/cpu_dma_latency; if it is empty, nothing is written.
  std::optional<int> cpu_dma_latency_us;
  std::vector<int> cpus;
};

}  // namespace softgrip::rig
