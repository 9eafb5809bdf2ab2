#pragma once
// Defines a cause: the sensor gives new readings more rarely than the log has samples, or its reading is
// frozen for some time.

#include "model/blocks/sampling.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

/// This cause is found from repeated readings (residual/sampling.h) and not by a fit.
struct Sampling : FormOf<model::Sampling> {
  static constexpr bool found_by_fitting = false;
  static constexpr WhenChanged when_changed{"the reading is updated too rarely or is frozen",
                                            {"Check the update rate and the averaging of the sensor.",
                                             "Read the sensor directly, without gateway or cache, and "
                                             "compare this reading with the reading in the log."}};
};

}  // namespace softgrip::sysid::causes
