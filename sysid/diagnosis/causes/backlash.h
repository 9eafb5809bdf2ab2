#pragma once
// Defines a cause: there is play between the actuator and the target of the sensor.

#include "model/blocks/backlash.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

struct Backlash : FormOf<model::Backlash> {
  static constexpr bool makes_distinguishable = true;
  static constexpr WhenChanged when_changed{
      "there is play between finger and sensor",
      {"Move the target of the sensor by hand and check if the target has play.",
       "Tighten the clamp of the sensor's target, then record the same log again."},
      {{{HealthNumber::loop_width, Moves::up}}},
      {SizedBy::Of::number, "play", "mm", "gap_mm"}};

  static Starts starts(const Scales& s) {
    return every({{"gap_mm", {0.01 * s.span_mm, 0.05 * s.span_mm, 0.15 * s.span_mm}}});
  }
  static Bounds bounds(const Scales& s, const model::Model&) { return {{"gap_mm", 0, 0.5 * s.span_mm}}; }
};

}  // namespace softgrip::sysid::causes
