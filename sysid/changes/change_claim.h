#pragma once
// Tests the conditions of sysid/evidence/veto.h for a cause of a change.

#include <cstdint>
#include <span>
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
  const RunSpread& spread;
  std::uint64_t seed = 1;
  /// Readings relative to the baseline models that were fitted without one healthy unit
  /// (left_out_readings()).
  std::span<const LaterReadings> left_out = {};

  /// Returns the causes in `found`, followed by one more.
  [[nodiscard]] std::vector<FittedEffect> with(const FittedEffect& one) const;
};

/// Returns one value per whitened reading: true if a cause must have an effect at the operating point of this
/// reading.
[[nodiscard]] std::vector<bool> required_rows(const LaterReadings& readings, Appears appears);

/// Returns the first condition that a cause does not meet, or Veto::none.
[[nodiscard]] Veto vetoed(const CauseSearch& search, const ScoredEffect& scored);

/// Returns true if the data cannot exclude a cause whose error reduction is smaller than that of the best
/// cause. The equations of a cause are approximate, so a slightly smaller error does not prove that the best
/// cause is the true one. The data cannot exclude a cause if its error reduction is at least half of that of
/// the best cause, and one of three conditions holds: the two causes tie, the error reductions differ by at
/// most 10 %, or the remaining error is within the spread of the healthy runs. A cause that only imitates the
/// best cause with more parameters is excluded.
[[nodiscard]] bool is_alternative(const CauseSearch& search, const ScoredEffect& best,
                                  const ScoredEffect& other, const Ties& ties);

}  // namespace softgrip::sysid
