#pragma once
// The finger rings: a mode of the second order.

#include "model/blocks/inertia.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

struct Inertia : FormOf<model::Inertia> {
  static constexpr bool makes_distinguishable = true;
  static constexpr WhenChanged when_changed{
      "the finger rings",
      {"Tap the finger and look whether its mounting or an added mass swings.",
       "Tighten the mounting, take added masses off, and record a sharp step."}};

  static Starts starts(const Scales&) {
    return every({{"period_s", {0.05, 0.15, 0.4, 1.0}}, {"damping_ratio", {0.15, 0.5}}});
  }
  static Bounds bounds(const Scales& s, const model::Model&) {
    // A shorter period than two samples is not seen; from a damping of 1/sqrt(2) on nothing resonates: two
    // lags in series.
    return {{"period_s", 2 * s.sample_s}, {"damping_ratio", 0.005, 0.7}};
  }
};

}  // namespace softgrip::sysid::causes
