#pragma once
// A forest plot of the error reductions of all causes and their alternatives.

#include "sysid/diagnosis/verdict/diagnosis.h"
#include "sysid/pages/figure.h"

namespace softgrip::sysid {

/// Requires at least one cause, named or partial.
[[nodiscard]] Figure forest_figure(const Diagnosis& diagnosis);

}  // namespace softgrip::sysid
