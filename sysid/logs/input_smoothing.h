#pragma once
// Measured inputs (pressure, supply, temperature) carry noise, and what drives a model with memory must not:
// every sample of noise would turn its hysteresis. They are smoothed with the noise that they show.

#include <span>
#include <vector>

namespace softgrip::sysid {

/// Standard deviation of white noise on a smooth signal, from the deviations of values from the straight line
/// between their neighbours (robust, any sampling); 0 for fewer than three values.
[[nodiscard]] double white_noise_of(std::span<const double> time_s, std::span<const double> values);

/// The signal without its noise: a Kalman filter forwards and Koopman's smoother backwards (Biometrika 80,
/// 1993) over a signal whose slope drifts. The noise is given; the drift rate has the greatest likelihood of
/// the innovations. The increments of the slope follow Student's t (with a scale for every step, by
/// expectation maximisation), so a signal with occasional jumps is smooth between them. Any sampling. Not
/// finite: no measurement there.
/// @param time_s  increasing, as long as `values`. @param noise  standard deviation; 0 returns the values.
[[nodiscard]] std::vector<double> smoothed(std::span<const double> time_s, std::span<const double> values,
                                           double noise);

/// Smooths a column in place where its noise is more than rounding: above 1e-4 of its range; what then still
/// turns back by less than five times the noise does not turn (turning_points.h). Returns the noise that it
/// found, 0 where it left the column alone.
double smooth_input(std::span<const double> time_s, std::vector<double>& values);

}  // namespace softgrip::sysid
