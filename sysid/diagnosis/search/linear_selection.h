#pragma once
// Choosing causes upon a base with many numbers of its own (play operators, a creep ladder). Beside a cause
// the base answers linearly, so that only the cause's few numbers are searched.

#include "sysid/diagnosis/search/selection.h"

namespace softgrip::sysid {

/// @param base  the base fitted to data.records.
/// @param options  one_cause_stands and to_beat_mm2 are not asked.
[[nodiscard]] Selection select_causes_upon(const SearchData& data, StructureFit base, double noise_mm,
                                           const Division& division, const SelectionOptions& options);

}  // namespace softgrip::sysid
