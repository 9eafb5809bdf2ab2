#pragma once
// Defines a cause: the measured loops differ in shape from the hysteresis of the model.

#include "model/blocks/prandtl_ishlinskii.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

/// No block represents this cause. It is found by fitting complete model structures with a different type of
/// hysteresis (verdict/base_findings.h).
struct HysteresisShape {
  static constexpr std::string_view id = "hysteresis_shape";
  static constexpr std::string_view title = "Hysteresis shape";
  static constexpr bool found_by_fitting = false;
  /// Empty, because the search for changes since the baseline does not test other types of hysteresis.
  static constexpr WhenChanged when_changed{};

  struct Plays : FormOf<model::PrandtlIshlinskii> {};

  using Forms = List<Plays>;
};

}  // namespace softgrip::sysid::causes
