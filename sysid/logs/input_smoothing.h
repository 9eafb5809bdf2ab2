#pragma once
// Smoothing of measured inputs (pressure, supply, temperature) according to their noise. The input of a model
// with hysteresis must not be noisy, because each noisy sample would reverse the hysteresis.

#include <span>
#include <vector>

namespace softgrip::sysid {

/// Returns the standard deviation of white noise on a smooth signal. It is a robust estimate from the
/// deviations of values from the straight line between their neighbours, for any sampling; 0 for fewer than
/// three values.
[[nodiscard]] double white_noise_of(std::span<const double> time_s, std::span<const double> values);

/// Returns the signal without its noise. The model of the signal is a level whose slope drifts. A Kalman
/// filter runs forwards and Koopman's smoother backwards (Biometrika 80, 1993). The noise is given; the drift
/// rate maximises the likelihood of the innovations. The increments of the slope follow Student's t
/// distribution (a scale for each step, by expectation maximisation), so a signal with occasional jumps is
/// smooth between them. The sampling may be irregular. A value that is not finite is a missing measurement.
/// @param time_s  increasing, as long as `values`. @param noise  standard deviation; 0 returns the values.
[[nodiscard]] std::vector<double> smoothed(std::span<const double> time_s, std::span<const double> values,
                                           double noise);

/// Smooths a column in place if its noise exceeds 1e-4 of its range, which is more than rounding. Reversals
/// of less than five times the noise are then removed (turning_points.h). Returns the noise, or 0 if the
/// column is unchanged.
double smooth_input(std::span<const double> time_s, std::vector<double>& values);

}  // namespace softgrip::sysid
