#pragma once
// Defines a cause: below a threshold pressure, the actuator does not move.

#include "model/blocks/actuator_threshold.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

struct ActuatorThreshold : FormOf<model::ActuatorThreshold> {
  static constexpr WhenChanged when_changed{
      "the finger does not move below a threshold pressure",
      {"Raise the pressure slowly from zero and note the pressure at which the finger starts to move.",
       "Check whether the bladder sticks together or a fold is creased. Inflate the finger fully once and "
       "repeat the test."},
      {},
      {SizedBy::Of::number, "threshold pressure", "kPa", "threshold_kpa"}};
  static Starts starts(const Scales& s) {
    return every({{"threshold_kpa", {0.02 * s.largest_kpa, 0.08 * s.largest_kpa, 0.2 * s.largest_kpa}}});
  }
  /// The threshold is at most 60 % of the largest pressure. With a higher threshold, the model would not move
  /// in most of the data, although the recorded finger moves.
  static Bounds bounds(const Scales& s, const model::Model&) {
    return {{"threshold_kpa", 0, 0.6 * s.largest_kpa}};
  }
};

}  // namespace softgrip::sysid::causes
