#pragma once
// A second-order mode of mass and spring (model/blocks/inertia.h) behind a structure that was fitted without
// one.

#include <limits>
#include <vector>

#include "sysid/fitting/fit_space.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

struct ResonantFit {
  FitPoint point;
  double rmse_mm = std::numeric_limits<double>::infinity();
};

/// The point with a resonance. Period and damping ratio are searched from several periods between 6 sampling
/// intervals and a tenth of the longest record (10 s at most). Dead time and time constants of the valve are
/// fitted with them; all other numbers stay.
[[nodiscard]] ResonantFit with_resonance(const FitPoint& point, const std::vector<Record>& records);

/// The point with the resonance of `resonant`, fitted from there to other readings of the same records.
[[nodiscard]] FitPoint with_resonance_of(const FitPoint& resonant, FitPoint point,
                                         const std::vector<Record>& records);

}  // namespace softgrip::sysid
