#pragma once
// Measures the noise of the readings without a model, and tests if a residual exceeds the noise.
// Defines the largest unexplained error for which a set of causes counts as complete.

#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Returns the standard deviation of the white noise of the readings [mm]. It is computed from third
/// differences of consecutive readings. Smooth motion and single wrong samples do not increase the result.
/// Rounding increases the result by the part of its error that is white noise.
[[nodiscard]] double white_noise_mm(const std::vector<Record>& records);

/// Returns the standard deviation of the noise of the readings [mm]. If the sensor is coarse
/// (Record::step_mm), the result contains the complete error by rounding. Otherwise it is the white noise.
[[nodiscard]] double measured_noise_mm(const std::vector<Record>& records);

/// The part of a residual that exceeds the measurement noise.
struct UnexplainedError {
  /// Square root of the mean square of the residual minus the noise variance; 0 if the noise variance is
  /// larger.
  double excess_mm = 0;
  double slow_correlation = 0;  ///< mean autocorrelation of the residual over the first 25 lags
  bool present = false;         ///< true: the residual exceeds the noise
};

/// Computes the unexplained error of a residual. The error by rounding of a coarse sensor is not part of it.
/// For a correct prediction, this error is the residual minus the nearest multiple of the step.
/// @param residual_mm  one vector per record; NaN for samples without a reading.
/// @param noise_mm  result of measured_noise_mm().
/// @param step_mm  size of the steps of the readings (Scales::step_mm); 0: the sensor is not coarse.
[[nodiscard]] UnexplainedError unexplained_error_of(const std::vector<std::vector<double>>& residual_mm,
                                                    double noise_mm, double step_mm);

/// Returns true if the unexplained error `left` is too large for a complete set of causes. The data then
/// contain a further effect, or the equation of a cause does not match the real effect.
/// @param before  unexplained error of the refitted model without causes.
[[nodiscard]] bool leaves_too_much(const UnexplainedError& left, const UnexplainedError& before,
                                   double noise_mm);

}  // namespace softgrip::sysid
