#pragma once
// Draws a forest plot of the error reductions by the named causes and their alternatives.

#include "sysid/diagnosis/verdict/diagnosis.h"
#include "sysid/pages/figure.h"

namespace softgrip::sysid {

/// Returns the forest plot. The diagnosis must contain at least one named cause or partial explanation.
[[nodiscard]] Figure forest_figure(const Diagnosis& diagnosis);

}  // namespace softgrip::sysid
