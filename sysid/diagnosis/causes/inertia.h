#pragma once
// Defines a cause: the finger has a second-order resonance and oscillates.

#include "model/blocks/inertia.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

struct Inertia : FormOf<model::Inertia> {
  static constexpr bool makes_distinguishable = true;
  static constexpr WhenChanged when_changed{
      "the finger oscillates after fast motions",
      {"Tap the finger and check whether its mounting or an added mass oscillates.",
       "Tighten the mounting, remove added masses, and record a sharp step."}};

  static Starts starts(const Scales& s) {
    return every({{"period_s", s.times_s({0.05, 0.15, 0.4, 1.0})}, {"damping_ratio", {0.15, 0.5}}});
  }
  static Bounds bounds(const Scales& s, const model::Model&) {
    // A period below two sampling intervals cannot be resolved. With a damping ratio of 1/sqrt(2) or more,
    // the block has no resonance peak and acts like two lags in series.
    return {{"period_s", 2 * s.sample_s}, {"damping_ratio", 0.005, 0.7}};
  }
};

}  // namespace softgrip::sysid::causes
