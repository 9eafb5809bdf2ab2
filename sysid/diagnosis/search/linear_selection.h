#pragma once
// Selects causes if the base structure has many parameters (play operators, a Kelvin-Voigt chain). The search
// varies only the few parameters of the cause. The parameters of the base structure are assumed to respond
// linearly to the cause.

#include "sysid/diagnosis/search/selection.h"

namespace softgrip::sysid {

/// Effort of the final fit of base structure and causes. This fit starts at the result of the selection.
inline constexpr FitEffort finishing_effort{.most_iterations = 15, .tolerance = 1e-6};

/// Selects causes in addition to a base structure.
/// @param base  base structure that was fitted to data.records.
/// @param options  the members one_cause_stands and to_beat_mm2 are not used.
[[nodiscard]] Selection select_causes_upon(const SearchData& data, StructureFit base, double noise_mm,
                                           const Division& division, const SelectionOptions& options);

}  // namespace softgrip::sysid
