#pragma once
// The reading is slower than its command, or frozen for an interval.

#include "model/blocks/sampling.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

/// Found by readings that repeat (residual/sampling.h), not fitted.
struct Sampling : FormOf<model::Sampling> {
  static constexpr bool found_by_fitting = false;
  static constexpr WhenChanged when_changed{
      "the reading is updated too rarely, or stops",
      {"Look at the update rate and the averaging of the sensor.",
       "Read the sensor directly, without gateway or cache, and compare."}};
};

}  // namespace softgrip::sysid::causes
