#pragma once
// Selects causes on a base structure with many parameters of its own (play operators, a Kelvin-Voigt chain).
// The search varies only the few parameters of the cause, and the parameters of the base structure respond
// linearly.

#include "sysid/diagnosis/search/selection.h"

namespace softgrip::sysid {

/// Effort of the final fit of base structure and causes, which starts at the result of the selection.
inline constexpr FitEffort finishing_effort{.most_iterations = 15, .tolerance = 1e-6};

/// Selects causes on a base structure.
/// @param base  base structure fitted to data.records.
/// @param options  one_cause_stands and to_beat_mm2 are ignored.
[[nodiscard]] Selection select_causes_upon(const SearchData& data, StructureFit base, double noise_mm,
                                           const Division& division, const SelectionOptions& options);

}  // namespace softgrip::sysid
