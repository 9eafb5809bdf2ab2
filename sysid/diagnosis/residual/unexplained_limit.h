#pragma once
// Defines the unexplained error that a complete set of causes may leave.

#include "sysid/diagnosis/residual/noise.h"

namespace softgrip::sysid {

/// Returns true if the unexplained error `left` is too large for the causes to be complete. In this case, the
/// data contain another effect, or a cause has a different form.
/// @param before  unexplained error of the refitted model without causes.
[[nodiscard]] bool leaves_too_much(const UnexplainedError& left, const UnexplainedError& before,
                                   double noise_mm);

}  // namespace softgrip::sysid
