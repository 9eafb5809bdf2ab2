#pragma once
// Defines a cause: the true scale of the valve or of the pressure sensor differs from the configured scale.

#include "model/blocks/pressure_scale.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

/// This cause is only listed as an alternative to a leak (verdict/valve_findings.h). The user enters the
/// scale. In the displacement, a wrong scale has the same effect as a different gain.
struct PressureScale : FormOf<model::PressureScale> {
  static constexpr bool found_by_fitting = false;
  /// This member is empty because no recorded quantity separates a change of the scale from a leak or from a
  /// change of the finger.
  static constexpr WhenChanged when_changed{};
};

}  // namespace softgrip::sysid::causes
