#pragma once
// Choosing causes upon a base with many numbers of its own (play operators, a creep ladder). Beside a cause
// the base answers linearly, so that only the cause's few numbers are searched.

#include "sysid/diagnosis/search/selection.h"

namespace softgrip::sysid {

/// Of a fit of base and causes that begins where choosing them ended.
inline constexpr FitEffort finishing_effort{.most_iterations = 15, .tolerance = 1e-6};

/// @param base  the base fitted to data.records.
/// @param options  one_cause_stands and to_beat_mm2 are not asked.
[[nodiscard]] Selection select_causes_upon(const SearchData& data, StructureFit base, double noise_mm,
                                           const Division& division, const SelectionOptions& options);

}  // namespace softgrip::sysid
