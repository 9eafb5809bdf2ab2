#pragma once
// Defines a cause: the reading saturates at a limit.

#include <algorithm>

#include "model/blocks/sensor_saturation.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

struct SensorSaturation : FormOf<model::SensorSaturation> {
  static constexpr std::array advice{Advice::change_load};
  static constexpr std::array<std::string_view, 1> counterparts{"contact"};
  static constexpr bool is_stop = true;
  static constexpr std::string_view sensor_shape = "a sensor that saturates at an end of its range";
  static constexpr WhenChanged when_changed{
      "the reading saturates",
      {"Check the distance between sensor and target: the range of the sensor must cover the whole stroke.",
       "Move the target by hand beyond the position at which the reading saturates, and note the reading."}};
  /// The lower limit is not fitted. It keeps the value no_floor_mm, which no reading reaches.
  static constexpr std::array<Parameter, 1> fitted{"upper_mm"};
  static constexpr double no_floor_mm = -1e4;

  static Starts starts(const Scales& s) {
    return every({{"lower_mm", {no_floor_mm}},
                  {"upper_mm", {0.97 * s.span_mm, 0.9 * s.span_mm, 0.75 * s.span_mm, 0.6 * s.span_mm}}});
  }
  /// Returns the parameter values of a block that saturates at `upper_mm`. The gauge check fits `upper_mm` to
  /// the gauge readings.
  static Values ending(double upper_mm) {
    return start({{"lower_mm", no_floor_mm}, {"upper_mm", std::max(upper_mm, 0.9 * no_floor_mm)}});
  }
};

}  // namespace softgrip::sysid::causes
