#pragma once
// Every cause and its alternatives with their error reductions, as a forest plot.

#include "sysid/diagnosis/verdict/diagnosis.h"
#include "sysid/pages/figure.h"

namespace softgrip::sysid {

/// At least one cause, named or in part.
[[nodiscard]] Figure forest_figure(const Diagnosis& diagnosis);

}  // namespace softgrip::sysid
