#pragma once
// The measured signals and their history as numbers by sample, for a regression that knows no physics.

#include <cstddef>
#include <string>
#include <vector>

#include "sysid/diagnosis/evidence/conditions.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

struct Features {
  struct Group {
    std::string id;
    std::string phrase;
    std::vector<std::size_t> columns;
  };
  std::vector<std::vector<double>> columns;  ///< by feature, then sample; finite
  std::vector<Group> groups;
};

/// The pressure, its rate, its last 0.4 s, its exponential averages up to the campaign's length, turning
/// points, the model's displacement and its rate, the largest load so far, the campaign's time; temperature
/// and supply where they vary.
[[nodiscard]] Features features_of(const std::vector<Record>& records,
                                   const std::vector<std::vector<double>>& prediction_mm,
                                   const Samples& samples);

}  // namespace softgrip::sysid
