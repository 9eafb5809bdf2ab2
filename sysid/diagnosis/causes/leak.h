#pragma once
// Pressure is lost between valve and finger.

#include "model/blocks/leak.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

/// This cause is found from a measured pressure below the command (verdict/valve_findings.h). In the
/// displacement, a leak has the same effect as a smaller gain.
struct Leak : FormOf<model::Leak> {
  static constexpr bool found_by_fitting = false;
  /// Empty, because a separate search finds a leak of a previously healthy finger
  /// (changes/causes_without_block.h).
  static constexpr WhenChanged when_changed{};
};

}  // namespace softgrip::sysid::causes
