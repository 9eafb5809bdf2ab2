#pragma once
// The settings in the `recorder` map of a rig file: contents, folder and write intervals of recordings.

#include <cstdint>
#include <string>

namespace softgrip::rig {

/// The map `recorder` of a rig file. rig/rig_keys.cpp declares the meaning and the range of each member.
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
  std::uint32_t decimation = 1;
  double flush_interval_s = 0.1;
  double sync_interval_s = 5;
  double history_s = 1;
};

}  // namespace softgrip::rig
