#pragma once
// The settings in the `recorder` map of a rig file: contents, folder and write intervals of recordings.

#include <cstdint>
#include <string>

namespace softgrip::rig {

struct RecorderSettings {
  enum class Mode : std::uint8_t {
    off,
    sequences,  ///< one folder per sequence, and one folder per fault, which begins with the rows from before
                ///< the fault
    always,     ///< one folder for the complete time from the start to the end of the daemon
  };
  Mode mode = Mode::sequences;
  /// Folder in which the daemon creates one folder per recording.
  std::string directory = "/var/lib/softgrip/runs";
  /// Every `decimation`-th tick is recorded; at least 1.
  std::uint32_t decimation = 1;
  /// Longest time between two writes to the kernel [s]; above 0 and at most 0.5. If the daemon is killed, the
  /// rows of this time are lost.
  double flush_interval_s = 0.1;
  /// Time between two writes to the disk (fdatasync) [s]. After a power failure, the rows of this time are
  /// lost. 0: the kernel decides when it writes to the disk.
  double sync_interval_s = 5;
  /// Duration for which past rows are kept in memory [s]. The recording of a fault begins with these rows.
  double history_s = 1;
};

}  // namespace softgrip::rig
