#pragma once
// What is recorded, where, and how often it reaches the disk; the `recorder` map of a rig file.

#include <cstdint>
#include <string>

namespace softgrip::rig {

struct RecorderSettings {
  enum class Mode : std::uint8_t {
    off,
    sequences,  ///< one folder per sequence, and one per fault with the second before it
    always,     ///< one folder from start to stop
  };
  Mode mode = Mode::sequences;
  /// Folder in which run folders are created.
  std::string directory = "/var/lib/softgrip/runs";
  /// Every how many ticks a row is recorded, at least 1.
  std::uint32_t decimation = 1;
  /// Rows reach the kernel (write) at least this often: what `kill -9` can lose. Above 0, at most 0.5 s.
  double flush_interval_s = 0.1;
  /// Rows reach the disk (fdatasync) this often: what a power failure can lose. 0: left to the kernel.
  double sync_interval_s = 5;
  /// Rows kept in memory before a recording starts, so that a fault has its last second attached [s].
  double history_s = 1;
};

}  // namespace softgrip::rig
