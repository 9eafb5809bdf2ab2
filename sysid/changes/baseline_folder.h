#pragma once
// Reads the folder of `softgrip baseline`: healthy_1.csv ..., second_1.csv ... of the run that checked them,
// gauge.csv, model.yaml, and baseline.json with the origin and hash of each.

#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace softgrip::sysid {

struct Baseline {
  std::vector<std::string> logs;    ///< paths inside the folder, in order
  std::vector<std::string> second;  ///< logs of the second run; empty: there was none
  std::string model;                ///< path of model.yaml
  std::string gauge;                ///< path of gauge.csv; empty: the sensor was not checked
};

/// Reads baseline.json and compares the hashes of the files that it names. The error is a sentence if the
/// folder is not a baseline or if a file was changed.
[[nodiscard]] tl::expected<Baseline, std::string> read_baseline(const std::string& folder);

}  // namespace softgrip::sysid
