#pragma once
// The scale of the valve or of the pressure sensor differs from the configured scale.

#include "model/blocks/pressure_scale.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

/// This cause is never named by itself, but is listed as an alternative to a leak (verdict/valve_findings.h).
/// The user enters the scale, and a wrong scale has the same effect on the displacement as a different gain.
struct PressureScale : FormOf<model::PressureScale> {
  static constexpr bool found_by_fitting = false;
  /// Empty, because a change of the scale has the same effect as a leak or a change of the finger, and no
  /// recorded quantity separates them.
  static constexpr WhenChanged when_changed{};
};

}  // namespace softgrip::sysid::causes
