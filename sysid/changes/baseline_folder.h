#pragma once
// Reads the folder that `softgrip baseline` has written. The folder contains the healthy logs (healthy_1.csv,
// healthy_2.csv, ...), model.yaml and baseline.json. It can also contain gauge.csv, and the logs of a second
// run (second_1.csv, ...) that checked the first run. baseline.json states the origin and the hash of each
// file.

#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace softgrip::sysid {

struct Baseline {
  std::vector<std::string> logs;    ///< paths of the healthy logs, including the folder, in the order of
                                    ///< baseline.json
  std::vector<std::string> second;  ///< paths of the logs of the second run, including the folder; empty:
                                    ///< there was no second run
  std::string model;                ///< path of model.yaml
  std::string channel;              ///< channel of the rig on which the logs were recorded; empty: the logs
                                    ///< come from files
  std::string gauge;                ///< path of gauge.csv; empty: the sensor was not checked
};

/// Reads baseline.json and compares the hashes of the files with the hashes in baseline.json. Returns an
/// error sentence if the folder is not a baseline or if a file was changed.
[[nodiscard]] tl::expected<Baseline, std::string> read_baseline(const std::string& folder);

}  // namespace softgrip::sysid
