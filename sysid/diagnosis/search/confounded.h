#pragma once
// Fits causes that can absorb part of the effect of an already selected cause (Cause::confounded_with), and
// tests each of them.

#include <vector>

#include "sysid/diagnosis/search/holdout.h"
#include "sysid/diagnosis/search/search.h"

namespace softgrip::sysid {

/// A structure to which a cause was added that is confounded with one of its causes.
struct Confounded {
  Cause cause;
  StructureFit fit;
  BlockLosses losses;  ///< held-out losses
};

/// For each cause that is confounded with a cause of the structure but not part of it, fits the structure
/// with that cause added. All parameters are fitted together.
[[nodiscard]] std::vector<Confounded> fit_confounded(const SearchData& data, const StructureFit& structure,
                                                     const Division& division);

}  // namespace softgrip::sysid
