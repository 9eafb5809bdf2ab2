#pragma once
// Isolated wrong samples.

#include "model/blocks/outliers.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

/// Found by comparison with neighbouring readings (residual/outliers.h), not by a fit, because no trajectory
/// contains them.
struct Outliers : FormOf<model::Outliers> {
  static constexpr bool found_by_fitting = false;
  static constexpr WhenChanged when_changed{
      "the readings contain outliers",
      {"Move the sensor's cable and connector while watching the reading.",
       "Replace the cable, and check the events for bus errors at the same times."}};
};

}  // namespace softgrip::sysid::causes
