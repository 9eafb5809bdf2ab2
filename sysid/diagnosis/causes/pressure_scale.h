#pragma once
// The scale of the valve or of the pressure sensor differs from the configured scale.

#include "model/blocks/pressure_scale.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

/// The alternative of a leak (verdict/valve_findings.h), never a name: a scale is a thing to enter, and in
/// displacements it is a gain.
struct PressureScale : FormOf<model::PressureScale> {
  static constexpr bool found_by_fitting = false;
  /// As a change, it looks like a leak or a change of the finger. No recorded quantity separates them.
  static constexpr WhenChanged when_changed{};
};

}  // namespace softgrip::sysid::causes
