#pragma once
// Defines a cause: pressure is lost through a leak between valve and finger.

#include "model/blocks/leak.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

/// This cause is found if the measured pressure stays below the command (verdict/valve_findings.h). The
/// displacement alone cannot separate a leak from a smaller gain of the finger.
struct Leak : FormOf<model::Leak> {
  static constexpr bool found_by_fitting = false;
  /// Empty, because a separate search finds a leak that has developed since the baseline was recorded
  /// (changes/causes_without_block.h).
  static constexpr WhenChanged when_changed{};
};

}  // namespace softgrip::sysid::causes
