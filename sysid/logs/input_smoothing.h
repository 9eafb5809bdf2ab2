#pragma once
// Smooths measured inputs (pressure, supply, temperature) as far as their noise requires. The input of a
// model with hysteresis must be free of noise, because noise would reverse the direction at each sample.

#include <span>
#include <vector>

namespace softgrip::sysid {

/// Returns the standard deviation of white noise on a smooth signal. The estimate is robust: it uses the
/// median deviation of a value from the straight line between its neighbours. The sampling may be irregular.
/// Returns 0 for fewer than three values.
[[nodiscard]] double white_noise_of(std::span<const double> time_s, std::span<const double> values);

/// Returns the signal without its noise. The model of the signal is a level with a slope that drifts. A
/// Kalman filter runs forwards, and Koopman's smoother runs backwards (Biometrika 80, 1993). The noise is
/// given. The drift rate of the slope maximises the likelihood of the innovations. The increments of the
/// slope follow Student's t distribution, so that the signal can jump occasionally and is still smooth
/// between the jumps. The scale of each step is found by expectation maximisation. The sampling may be
/// irregular. A value that is not finite is a missing measurement.
/// @param time_s  increasing, as long as `values`. @param noise  standard deviation; 0 returns the values.
[[nodiscard]] std::vector<double> smoothed(std::span<const double> time_s, std::span<const double> values,
                                           double noise);

/// Smooths a column in place if its noise exceeds 1e-4 of its range; smaller noise is rounding. Then removes
/// reversals of less than five times the noise (turning_points.h). Returns the noise, or 0 if the column is
/// unchanged.
double smooth_input(std::span<const double> time_s, std::vector<double>& values);

}  // namespace softgrip::sysid
