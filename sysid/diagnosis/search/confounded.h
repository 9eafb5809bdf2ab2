#pragma once
// Fits causes that can absorb part of the effect of a selected cause (Cause::confounded_with), and tests
// whether the data require each of them.

#include <vector>

#include "sysid/diagnosis/search/holdout.h"
#include "sysid/diagnosis/search/search.h"

namespace softgrip::sysid {

/// A structure with one additional cause. This cause is confounded with another cause of the structure.
struct Confounded {
  Cause cause;
  StructureFit fit;
  BlockLosses losses;  ///< losses on held-out blocks
};

/// Fits the structure with one more cause, for each cause that is confounded with a cause of the structure
/// but is not part of the structure. Each fit changes all parameters together.
[[nodiscard]] std::vector<Confounded> fit_confounded(const SearchData& data, const StructureFit& structure,
                                                     const Division& division);

}  // namespace softgrip::sysid
