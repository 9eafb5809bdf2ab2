#pragma once
// Isolated wrong samples.

#include "model/blocks/outliers.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

/// Counted against their neighbours (residual/outliers.h), not fitted: no trajectory shows them.
struct Outliers : FormOf<model::Outliers> {
  static constexpr bool found_by_fitting = false;
};

}  // namespace softgrip::sysid::causes
