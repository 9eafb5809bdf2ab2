#pragma once
// Isolated wrong samples.

#include "model/blocks/outliers.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

/// Counted against their neighbours (residual/outliers.h), not fitted: no trajectory shows them.
struct Outliers : FormOf<model::Outliers> {
  static constexpr bool found_by_fitting = false;
  static constexpr WhenChanged when_changed{
      "single readings are wrong",
      {"Move the sensor's cable and connector while watching the reading.",
       "Swap the cable, and look in the events for bus errors at the same times."}};
};

}  // namespace softgrip::sysid::causes
