#pragma once
// How much a set of causes may leave and still be called the cause.

#include "sysid/diagnosis/residual/noise.h"

namespace softgrip::sysid {

/// Whether what is left of a structure is too much: beyond it something else is at work, or the cause has
/// another form.
/// @param before  what the recalibrated model leaves.
[[nodiscard]] bool leaves_too_much(const Structure& left, const Structure& before, double noise_mm);

}  // namespace softgrip::sysid
