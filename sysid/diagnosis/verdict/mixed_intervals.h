#pragma once
// Computes intervals of parameters over several plausible structures. The value of a parameter depends on the
// other causes in the structure. If the data do not show whether a confounded cause is present, the interval
// covers the values with and without this cause.

#include <cstdint>
#include <string>
#include <vector>

#include "sysid/diagnosis/search/selection.h"
#include "sysid/diagnosis/verdict/named_cause.h"

namespace softgrip::sysid {

/// Widens the intervals of `named`, the chosen causes of `selection`. Each interval then also covers the
/// values of the parameter in other plausible structures: the undecided structures that the held-out blocks
/// do not exclude. Returns a sentence for each widened interval.
[[nodiscard]] std::vector<std::string> mix_intervals(std::vector<NamedCause>& named,
                                                     const std::vector<Record>& records,
                                                     const Selection& selection, std::uint64_t seed);

}  // namespace softgrip::sysid
