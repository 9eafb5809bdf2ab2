#pragma once
// Tests the conditions of sysid/evidence/veto.h for a cause of a change.

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "sysid/changes/change_intervals.h"
#include "sysid/changes/change_search.h"
#include "sysid/changes/healthy_runs.h"
#include "sysid/evidence/signature.h"
#include "sysid/evidence/veto.h"

namespace softgrip::sysid {

/// State of a search for a further cause.
struct CauseSearch {
  const LaterReadings& readings;
  const std::vector<FittedEffect>& found;  ///< causes that were found before
  const Eigen::VectorXd& without;          ///< whitened residuals with the causes in `found`
  const std::vector<HealthyFits>& healthy;
  std::uint64_t seed = 1;

  /// Returns the causes in `found`, followed by one more.
  [[nodiscard]] std::vector<FittedEffect> with(const FittedEffect& one) const;
};

/// Returns one value per whitened reading: true if a cause must have an effect at the operating point of this
/// reading.
[[nodiscard]] std::vector<bool> required_rows(const LaterReadings& readings, Appears appears);

/// Returns the first condition that a cause does not meet, or Veto::none.
[[nodiscard]] Veto vetoed(const CauseSearch& search, const ScoredEffect& scored);

}  // namespace softgrip::sysid
