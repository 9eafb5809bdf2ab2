#pragma once
// Pressure is lost on the way to the finger.

#include "model/blocks/leak.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

/// Found where the measured pressure stays below the command (verdict/valve_findings.h): in displacements a
/// leak is a smaller gain.
struct Leak : FormOf<model::Leak> {
  static constexpr bool found_by_fitting = false;
  /// A search of its own finds its effect on a healthy finger (changes/causes_without_block.h).
  static constexpr WhenChanged when_changed{};
};

}  // namespace softgrip::sysid::causes
