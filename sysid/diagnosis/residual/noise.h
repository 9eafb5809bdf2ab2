#pragma once
// Measures the noise of the readings without a model, and tests whether a residual exceeds the noise.
// Defines the largest unexplained error with which a set of causes counts as complete.

#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Returns the standard deviation of the random change between consecutive samples [mm], computed from third
/// differences. Smooth motion and single wrong samples do not contribute to the result; quantisation does.
[[nodiscard]] double measured_noise_mm(const std::vector<Record>& records);

/// The part of a residual that exceeds the measurement noise.
struct UnexplainedError {
  /// Square root of (mean square of the residual - noise squared); 0 if this difference is negative.
  double excess_mm = 0;
  double slow_correlation = 0;  ///< mean autocorrelation of the residual over the first 25 lags
  bool present = false;         ///< true: the residual exceeds the noise
};

/// Returns the unexplained error in a residual.
/// @param residual_mm  one vector per record; NaN for samples without a reading.
[[nodiscard]] UnexplainedError unexplained_error_of(const std::vector<std::vector<double>>& residual_mm,
                                                    double noise_mm);

/// Returns true if the unexplained error `left` is too large for a complete set of causes. In this case, the
/// data contain another effect, or the equation of a cause does not match the real effect.
/// @param before  unexplained error of the refitted model without causes.
[[nodiscard]] bool leaves_too_much(const UnexplainedError& left, const UnexplainedError& before,
                                   double noise_mm);

}  // namespace softgrip::sysid
