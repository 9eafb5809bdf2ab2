#pragma once
// Every cause with its gain, its rivals with theirs, as a forest plot.

#include "sysid/diagnosis/verdict/diagnosis.h"
#include "sysid/pages/figure.h"

namespace softgrip::sysid {

/// At least one cause, named or in part.
[[nodiscard]] Figure forest_figure(const Diagnosis& diagnosis);

}  // namespace softgrip::sysid
