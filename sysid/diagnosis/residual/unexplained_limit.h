#pragma once
// Defines the largest unexplained error with which a set of causes counts as complete.

#include "sysid/diagnosis/residual/noise.h"

namespace softgrip::sysid {

/// Returns true if the unexplained error `left` is too large for a complete set of causes. In this case, the
/// data contain another effect, or the equation of a cause does not match the real effect.
/// @param before  unexplained error of the refitted model without causes.
[[nodiscard]] bool leaves_too_much(const UnexplainedError& left, const UnexplainedError& before,
                                   double noise_mm);

}  // namespace softgrip::sysid
