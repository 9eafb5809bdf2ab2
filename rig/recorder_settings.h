#pragma once
// Contents, folder and write intervals of recordings; the `recorder` map of a rig file.

#include <cstdint>
#include <string>

namespace softgrip::rig {

struct RecorderSettings {
  enum class Mode : std::uint8_t {
    off,
    sequences,  ///< one folder per sequence, and one per fault with the rows before the fault
    always,     ///< one folder from the start to the end of the daemon
  };
  Mode mode = Mode::sequences;
  /// Folder in which run folders are created.
  std::string directory = "/var/lib/softgrip/runs";
  /// A row is recorded every `decimation` ticks, at least 1.
  std::uint32_t decimation = 1;
  /// Longest interval between writes to the kernel [s], above 0 and at most 0.5. If the daemon is killed, the
  /// rows of this time are lost.
  double flush_interval_s = 0.1;
  /// Interval between writes to the disk (fdatasync) [s]. After a power failure, the rows of this time are
  /// lost. 0: the kernel decides when to write.
  double sync_interval_s = 5;
  /// Duration for which past rows are kept in memory [s]. The recording of a fault begins with these rows.
  double history_s = 1;
};

}  // namespace softgrip::rig
