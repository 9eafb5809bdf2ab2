#pragma once
// The provenance of a recording: all contents of run.json except the events.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace softgrip::daemon {

/// A file that the recorded run used, with its hash.
struct SourceFile {
  std::string role;  ///< purpose of the file: "rig", "board", "model" or "plant"
  std::string path;
  std::string sha256;
};

/// Data that are the same in all recordings of a daemon.
struct Provenance {
  std::string software_version;
  std::string rig;  ///< name of the recorded rig
  std::vector<SourceFile> files;
  std::vector<std::string> channel_names;
  bool simulated = false;          ///< true: there is no real board; fingers, valves and sensors are
                                   ///< simulated
  bool measures_pressure = false;  ///< true: at least one channel has a measured pressure
  bool measures_temperature = false;
  double rate_hz = 0;
  std::uint32_t decimation = 1;
  std::optional<std::uint64_t> seed;  ///< seed of a simulated board; empty for a real board
  bool virtual_time = false;          ///< true: the run is in virtual time, so its recording contains no
                                      ///< wall-clock time
};

}  // namespace softgrip::daemon
