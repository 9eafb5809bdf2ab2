#pragma once
// Adds a second-order mode (a mass on a spring, model/blocks/inertia.h) to a fitted structure, and fits the
// parameters of the mode.

#include <limits>
#include <vector>

#include "sysid/fitting/fit_space.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

struct ResonantFit {
  FitPoint point;
  double rmse_mm = std::numeric_limits<double>::infinity();
};

/// Parameters that the fit of a resonance may change.
enum class ResonanceFit {
  dynamics,  ///< resonance, dead time, lags and rate limit. The initial states of the records stay fixed.
             ///< This fit is fast.
  complete   ///< all parameters of the structure, starting from the result of `dynamics`
};

/// Adds a resonance to a fitted model and fits it. The search for the period and the damping ratio starts
/// from several periods. The shortest start period is 6 sampling intervals. The longest one is 10 % of the
/// longest record, at most 10 units of time_unit_s().
[[nodiscard]] ResonantFit with_resonance(const FitPoint& point, const std::vector<Record>& records,
                                         ResonanceFit fit);

/// Adds the resonance of `resonant` to `point` and fits the result to `records`. The fit starts at the
/// parameters of `resonant`. `records` are the records to which `resonant` was fitted, with modified
/// readings.
[[nodiscard]] FitPoint with_resonance_of(const FitPoint& resonant, FitPoint point,
                                         const std::vector<Record>& records, ResonanceFit fit);

}  // namespace softgrip::sysid
