#pragma once
// Reads the folder that `softgrip baseline` has written. It contains healthy_1.csv and further healthy logs,
// second_1.csv and further logs of a second run that checked the first run, gauge.csv, model.yaml and
// baseline.json. baseline.json states the origin and the hash of each file.

#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace softgrip::sysid {

struct Baseline {
  std::vector<std::string> logs;    ///< paths of the healthy logs, relative to the folder, in their order
  std::vector<std::string> second;  ///< paths of the logs of the second run; empty: there was no second run
  std::string model;                ///< path of model.yaml
  std::string gauge;                ///< path of gauge.csv; empty: the sensor was not checked
};

/// Reads baseline.json and compares the hashes of the files with those in baseline.json. The error is a
/// sentence if the folder is not a baseline or if a file was changed.
[[nodiscard]] tl::expected<Baseline, std::string> read_baseline(const std::string& folder);

}  // namespace softgrip::sysid
