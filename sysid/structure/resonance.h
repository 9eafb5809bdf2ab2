#pragma once
// Adds a second-order mode of mass and spring (model/blocks/inertia.h) to a fitted structure, and fits the
// mode.

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
  dynamics,  ///< resonance, dead time, lags and rate limit. Start states stay fixed. This fit is fast.
  complete   ///< all parameters of the structure, starting from the result of `dynamics`
};

/// Adds a resonance to a point and fits it. The search for period and damping ratio starts from several
/// periods between 6 sampling intervals and 10 % of the longest record (at most 10 units of
/// time_unit_s()).
[[nodiscard]] ResonantFit with_resonance(const FitPoint& point, const std::vector<Record>& records,
                                         ResonanceFit fit);

/// Adds the resonance of `resonant` to `point` and fits it to modified readings of the same records. The fit
/// starts at the parameters of `resonant`.
[[nodiscard]] FitPoint with_resonance_of(const FitPoint& resonant, FitPoint point,
                                         const std::vector<Record>& records, ResonanceFit fit);

}  // namespace softgrip::sysid
