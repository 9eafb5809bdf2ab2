#pragma once
// A reference without structure: how much of a residual any smooth function of the measured signals and
// their history could explain.
//
// Ridge regression (Hoerl and Kennard 1970) on the features, then boosted trees (boosting.h) on what it
// leaves, judged on contiguous blocks that neither saw, with a gap. The number of trees and the penalty for a
// block are chosen on the other blocks. What it explains is there to be explained, so it bounds from below
// what a named cause could still gain; what it does not explain may still have a cause.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "sysid/diagnosis/search/holdout.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// What the reference draws on, by group.
struct FeatureGroup {
  std::string id;                 ///< "slow_pressure"
  std::string phrase;             ///< "the pressure over the last seconds and minutes"
  double importance_percent = 0;  ///< of the structural variance, lost when the group is shuffled
};

struct Reference {
  double structural_mm = 0;   ///< root of the residual's variance beyond the noise
  bool present = false;       ///< there is structure to explain
  Spread explained_percent;   ///< of the structural variance, held out; not below 0
  double linear_percent = 0;  ///< by the ridge regression alone
  double rmse_before_mm = 0;
  double rmse_after_mm = 0;          ///< held out
  std::vector<FeatureGroup> groups;  ///< most important first
};

struct ReferenceOptions {
  std::size_t most_samples = 6000;
  double block_s = 8;
  std::size_t folds = 5;
  std::uint64_t seed = 1;
  unsigned threads = 0;
};

/// @param prediction_mm  of the model whose residual it is, by record.
/// @param residual_mm  by record; NaN without reading.
[[nodiscard]] Reference smooth_reference(const std::vector<Record>& records,
                                         const std::vector<std::vector<double>>& prediction_mm,
                                         const std::vector<std::vector<double>>& residual_mm, double noise_mm,
                                         const ReferenceOptions& options = {});

}  // namespace softgrip::sysid
