#pragma once
// Defines a cause: the shape of the measured hysteresis loops differs from the shape that the model can
// describe.

#include "model/blocks/prandtl_ishlinskii.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

/// No block adds this cause to a model. The cause is found if a complete model structure with a different
/// type of hysteresis fits better (verdict/base_findings.h).
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
