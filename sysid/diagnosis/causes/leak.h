#pragma once
// Pressure is lost on the way to the finger.

#include "model/blocks/leak.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

/// Found where the measured pressure stays below the command (verdict/valve_findings.h): in displacements a
/// leak is a smaller gain.
struct Leak : FormOf<model::Leak> {
  static constexpr bool found_by_fitting = false;
  /// What it does to a finger that was healthy is told by its own search (changes/causes_without_block.h).
  static constexpr WhenChanged when_changed{};
};

}  // namespace softgrip::sysid::causes
