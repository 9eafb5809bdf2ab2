#pragma once
// Defines a cause: single readings are wrong (outliers).

#include "model/blocks/outliers.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

/// This cause is found by a comparison of each reading with its neighbours (residual/outliers.h). A fit
/// cannot find the cause, because a simulated trajectory contains no outliers.
struct Outliers : FormOf<model::Outliers> {
  static constexpr bool found_by_fitting = false;
  static constexpr WhenChanged when_changed{
      "the readings contain outliers",
      {"Move the sensor's cable and connector while watching the reading.",
       "Replace the cable, and check the events for bus errors at the times of the outliers."}};
};

}  // namespace softgrip::sysid::causes
