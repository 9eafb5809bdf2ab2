#pragma once
// Defines a cause: the true scale of the valve or of the pressure sensor differs from the configured scale.

#include "model/blocks/pressure_scale.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

/// A diagnosis lists this cause only as an alternative to a leak (verdict/valve_findings.h). The scale is a
/// setting that the user enters. The displacement alone cannot separate a wrong scale from a different gain
/// of the finger.
struct PressureScale : FormOf<model::PressureScale> {
  static constexpr bool found_by_fitting = false;
  /// Empty, because no recorded quantity can separate a changed scale from a leak or from a change of the
  /// finger.
  static constexpr WhenChanged when_changed{};
};

}  // namespace softgrip::sysid::causes
