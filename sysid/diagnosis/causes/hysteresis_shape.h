#pragma once
// Defines a cause: the measured loops differ in shape from the hysteresis of the model.

#include "model/blocks/prandtl_ishlinskii.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

/// This cause has no block. It is found by fits of complete alternative base structures
/// (verdict/base_findings.h).
struct HysteresisShape {
  static constexpr std::string_view id = "hysteresis_shape";
  static constexpr std::string_view title = "Hysteresis shape";
  static constexpr bool found_by_fitting = false;
  /// This member is empty because the search for a change since the baseline does not change the form of the
  /// base structure.
  static constexpr WhenChanged when_changed{};

  struct Plays : FormOf<model::PrandtlIshlinskii> {};

  using Forms = List<Plays>;
};

}  // namespace softgrip::sysid::causes
