#pragma once
// Smooths measured inputs (pressure, supply, temperature) according to their noise. The input of a model with
// hysteresis must be free of noise, because noise would reverse the direction of the input at each sample.

#include <span>
#include <vector>

namespace softgrip::sysid {

/// Returns the standard deviation of white noise on a smooth signal. The estimate is robust: it is the median
/// deviation of a value from the straight line between its neighbours, scaled to a standard deviation. The
/// sampling may be irregular. Values that are not finite are left out, because a sensor may be slower than
/// the log. Returns 0 for fewer than three finite values.
[[nodiscard]] double white_noise_of(std::span<const double> time_s, std::span<const double> values);

/// Returns the signal without its noise. The model of the signal is a level with a slope that drifts. A
/// Kalman filter runs forwards, and Koopman's smoother runs backwards (Biometrika 80, 1993). The drift rate
/// of the slope is the one that maximises the likelihood of the innovations. The increments of the slope
/// follow Student's t distribution. The signal can therefore jump occasionally, and it is smooth between the
/// jumps. Expectation maximisation estimates the scale of the increment in each step. The sampling may be
/// irregular. A value that is not finite is a missing measurement.
/// @param time_s  increasing times, one for each element of `values`.
/// @param noise  standard deviation of the noise; if it is 0, the function returns `values`.
[[nodiscard]] std::vector<double> smoothed(std::span<const double> time_s, std::span<const double> values,
                                           double noise);

/// Smooths a column in place if its noise exceeds 1e-4 of its range; smaller noise hardly affects the
/// response of a model. Then removes reversals that are smaller than five times the noise (excitation.h).
/// Returns the noise, or 0 if the column was not changed.
double smooth_input(std::span<const double> time_s, std::vector<double>& values);

}  // namespace softgrip::sysid
