#pragma once
// Finds the resolution of a sensor with coarse steps, and measures the noise that such steps hide.

#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Returns the size of the steps of the readings [mm] if the sensor is coarse, otherwise 0.
///
/// A sensor counts as coarse under three conditions. Nearly all differences of consecutive readings are whole
/// multiples of the step. The step is at least 1/1000 of the span of the readings. The error by rounding,
/// which has the variance step^2 / 12, is at least half of the variance of the noise.
[[nodiscard]] double coarse_step_mm(const std::vector<Record>& records);

/// Returns the standard deviation of the noise of the readings before they are rounded [mm]. It is computed
/// from readings during slow motion. If all motion is fast, the error by rounding is white noise, and the
/// result is computed from `white_mm`.
///
/// Source: B. Widrow and I. Kollar, Quantization Noise, Cambridge University Press 2008, chapter 4. The mean
/// error by rounding at a displacement x is a periodic function of x with the amplitudes
/// step / (pi k) exp(-2 (pi k noise / step)^2), k = 1, 2, ... During slow motion, this mean error is not
/// white noise.
/// @param step_mm  size of the steps of the readings, > 0.
/// @param white_mm  standard deviation of all white noise of the rounded readings.
[[nodiscard]] double noise_before_rounding_mm(const std::vector<Record>& records, double step_mm,
                                              double white_mm);

/// Returns the variance of the error that rounding to steps causes [mm^2]: step^2 / 12.
[[nodiscard]] constexpr double rounding_variance_mm2(double step_mm) {
  return step_mm * step_mm / 12;
}

}  // namespace softgrip::sysid
