#pragma once
// The loops are not of the model's form.

#include "model/blocks/prandtl_ishlinskii.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

/// Found by fitting whole bases beside each other (verdict/base_findings.h), not by adding a block to one.
struct HysteresisShape {
  static constexpr std::string_view id = "hysteresis_shape";
  static constexpr std::string_view title = "Hysteresis shape";
  static constexpr bool found_by_fitting = false;
  /// The form of a base is frozen where a change is looked for.
  static constexpr WhenChanged when_changed{};

  struct Plays : FormOf<model::PrandtlIshlinskii> {};

  using Forms = List<Plays>;
};

}  // namespace softgrip::sysid::causes
