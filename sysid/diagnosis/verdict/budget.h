#pragma once
// Computes the error budget of a diagnosis: the mean square errors of the given, the refitted and the
// extended model on held-out readings, and the noise variance.

#include <algorithm>

#include "sysid/diagnosis/verdict/diagnosis.h"

namespace softgrip::sysid {

/// Error budget of a diagnosis. All values are mean squares [mm^2].
struct Budget {
  double as_given = 0;
  double recalibrated = 0;
  double extended = 0;
  double noise = 0;

  /// Returns the mean square error of the refitted model minus the noise variance.
  [[nodiscard]] double excess() const { return std::max(recalibrated - noise, 0.0); }
  /// Returns the mean square error of the extended model minus the noise variance.
  [[nodiscard]] double left() const { return std::max(extended - noise, 0.0); }
  /// Returns the share of excess() that one cause explains, from 0 to 100 %. This share is the increase of
  /// the mean square error when the cause is removed, divided by excess().
  [[nodiscard]] double share_percent(const NamedCause& named) const {
    return excess() > 0 ? std::clamp(100 * named.gain_mm2.value / excess(), 0.0, 100.0) : 0.0;
  }
};

[[nodiscard]] inline Budget budget_of(const Diagnosis& d) {
  return {d.as_given_rmse_mm * d.as_given_rmse_mm, d.recalibrated_rmse_mm * d.recalibrated_rmse_mm,
          d.extended_rmse_mm * d.extended_rmse_mm, d.noise_mm * d.noise_mm};
}

}  // namespace softgrip::sysid
