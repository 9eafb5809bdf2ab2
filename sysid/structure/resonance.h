#pragma once
// Fits a second-order mode of mass and spring (model/blocks/inertia.h) that is added to an already fitted
// structure.

#include <limits>
#include <vector>

#include "sysid/fitting/fit_space.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

struct ResonantFit {
  FitPoint point;
  double rmse_mm = std::numeric_limits<double>::infinity();
};

/// Adds a resonance to a point and fits it. The search for period and damping ratio starts from several
/// periods between 6 sampling intervals and 10 % of the longest record (at most 10 s). The dead time and the
/// time constants of the valve are fitted as well. All other parameters stay fixed.
[[nodiscard]] ResonantFit with_resonance(const FitPoint& point, const std::vector<Record>& records);

/// Adds the resonance of `resonant` to `point` and fits it to other readings of the same records. The fit
/// starts from the parameters of `resonant`.
[[nodiscard]] FitPoint with_resonance_of(const FitPoint& resonant, FitPoint point,
                                         const std::vector<Record>& records);

}  // namespace softgrip::sysid
