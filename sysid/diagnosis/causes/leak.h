#pragma once
// Pressure is lost between valve and finger.

#include "model/blocks/leak.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

/// Found by a measured pressure below the command (verdict/valve_findings.h). In the displacement, a leak
/// looks like a smaller gain.
struct Leak : FormOf<model::Leak> {
  static constexpr bool found_by_fitting = false;
  /// A separate search finds its effect on a healthy finger (changes/causes_without_block.h).
  static constexpr WhenChanged when_changed{};
};

}  // namespace softgrip::sysid::causes
