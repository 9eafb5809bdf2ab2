#pragma once
// Limits the unexplained error that a set of causes may leave.

#include "sysid/diagnosis/residual/noise.h"

namespace softgrip::sysid {

/// Returns true if the unexplained error is too large. In that case another effect is present, or the cause
/// has a different form.
/// @param before  unexplained error of the refitted model.
[[nodiscard]] bool leaves_too_much(const UnexplainedError& left, const UnexplainedError& before,
                                   double noise_mm);

}  // namespace softgrip::sysid
