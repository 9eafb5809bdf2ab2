#pragma once
// Contents, folder and write intervals of recordings; the `recorder` map of a rig file.

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
  /// A row is recorded every `decimation` ticks, at least 1.
  std::uint32_t decimation = 1;
  /// Longest interval between writes to the kernel [s], above 0 and at most 0.5. `kill -9` loses the rows of
  /// this time.
  double flush_interval_s = 0.1;
  /// Interval between writes to the disk (fdatasync) [s]. A power failure loses the rows of this time. 0:
  /// kernel decides.
  double sync_interval_s = 5;
  /// Duration of the rows in memory before a recording starts [s]. They are added to the recording of a
  /// fault.
  double history_s = 1;
};

}  // namespace softgrip::rig
