#pragma once
// Where a recording comes from: what run.json says besides events.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace softgrip::daemon {

/// A file that shaped the run, by its content.
struct SourceFile {
  std::string role;  ///< "rig", "board", "model", "plant"
  std::string path;
  std::string sha256;
};

/// Data that all recordings of a daemon share.
struct Provenance {
  std::string software_version;
  std::string rig;  ///< its name
  std::vector<SourceFile> files;
  std::vector<std::string> channel_names;
  bool simulated = false;          ///< no board: fingers, valves and sensors are computed
  bool measures_pressure = false;  ///< some channel does
  bool measures_temperature = false;
  double rate_hz = 0;
  std::uint32_t decimation = 1;
  std::optional<std::uint64_t> seed;  ///< of a simulated board
  bool virtual_time = false;          ///< a recording then contains no wall-clock time
};

}  // namespace softgrip::daemon
