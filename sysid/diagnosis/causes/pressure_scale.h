#pragma once
// The scale of the valve or of the pressure sensor differs from the configured scale.

#include "model/blocks/pressure_scale.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

/// Only an alternative to a leak (verdict/valve_findings.h), never a named cause. The user enters the scale,
/// and in the displacement it looks like a gain.
struct PressureScale : FormOf<model::PressureScale> {
  static constexpr bool found_by_fitting = false;
  /// As a change, it looks like a leak or a change of the finger. No recorded quantity separates them.
  static constexpr WhenChanged when_changed{};
};

}  // namespace softgrip::sysid::causes
