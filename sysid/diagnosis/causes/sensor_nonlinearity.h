#pragma once
// Defines a cause: the scale of the sensor is nonlinear.

#include "model/blocks/sensor_nonlinearity.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

struct SensorNonlinearity : FormOf<model::SensorNonlinearity> {
  static constexpr std::array advice{Advice::change_load};
  static constexpr std::string_view indistinguishable = "stiffening";
  static constexpr std::array<std::string_view, 1> counterparts{"stiffening"};
  static constexpr std::string_view sensor_shape = "a nonlinear sensor scale";
  static constexpr WhenChanged when_changed{
      "the scale of the sensor is nonlinear",
      {"Check whether the sensor has been displaced or its target is tilted.",
       "Measure five positions with a gauge (`softgrip diagnose --gauge`)."}};
  /// The calibrated range `range_mm` is not fitted, because the size of the nonlinearity is defined relative
  /// to this range.
  static constexpr std::array<Parameter, 2> fitted{"bow_mm", "wave_mm"};

  static Starts starts(const Scales& s) {
    return every(
        {{"bow_mm", {-0.02 * s.span_mm, 0.02 * s.span_mm}}, {"wave_mm", {0.0}}, {"range_mm", {s.span_mm}}});
  }
  /// Returns the parameter values at which a fit to gauge readings starts.
  static Values bent(double bow_mm, double wave_mm, double range_mm) {
    return start({{"bow_mm", bow_mm}, {"wave_mm", wave_mm}, {"range_mm", range_mm}});
  }
};

}  // namespace softgrip::sysid::causes
