#pragma once
// Fits causes that can absorb part of the effect of a selected cause (Cause::confounded_with), and tests
// whether the data require each of these causes.

#include <vector>

#include "sysid/diagnosis/search/holdout.h"
#include "sysid/diagnosis/search/search.h"

namespace softgrip::sysid {

/// A structure to which one cause was added. The added cause is confounded with another cause of the
/// structure.
struct Confounded {
  Cause cause;
  StructureFit fit;
  BlockLosses losses;  ///< losses on held-out blocks
};

/// Adds each cause that is confounded with a cause of the structure, one at a time, and fits the resulting
/// structure. Each fit changes all parameters together. Causes that are already part of the structure are not
/// added.
[[nodiscard]] std::vector<Confounded> fit_confounded(const SearchData& data, const StructureFit& structure,
                                                     const Division& division);

}  // namespace softgrip::sysid
