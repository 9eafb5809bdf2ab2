#pragma once
// Intervals over the confidence set: what a number is depends on what else is there, and where data do not
// say whether a confounded cause is there, its interval holds both answers.

#include <cstdint>
#include <string>
#include <vector>

#include "sysid/diagnosis/search/selection.h"
#include "sysid/diagnosis/verdict/named_cause.h"

namespace softgrip::sysid {

/// Widens the intervals of `named` (the chosen of `selection`) by every undecided structure that the held-out
/// blocks do not rule out. Returns a sentence for each.
[[nodiscard]] std::vector<std::string> mix_intervals(std::vector<NamedCause>& named,
                                                     const std::vector<Record>& records,
                                                     const Selection& selection, std::uint64_t seed);

}  // namespace softgrip::sysid
