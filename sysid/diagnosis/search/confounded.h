#pragma once
// Fits causes that can absorb part of each other's effect (Cause::confounded_with), each as a separate test.

#include <vector>

#include "sysid/diagnosis/search/holdout.h"
#include "sysid/diagnosis/search/search.h"

namespace softgrip::sysid {

/// A structure with one more cause that is confounded with one of its causes.
struct Confounded {
  Cause cause;
  StructureFit fit;
  BlockLosses losses;  ///< held-out losses
};

/// Fits each cause that is confounded with a cause of the structure and is not yet part of it. All causes are
/// fitted together.
[[nodiscard]] std::vector<Confounded> fit_confounded(const SearchData& data, const StructureFit& structure,
                                                     const Division& division);

}  // namespace softgrip::sysid
