#pragma once
// Causes that take a share of each other's numbers (Cause::confounded_with): asked for by themselves.

#include <vector>

#include "sysid/diagnosis/search/holdout.h"
#include "sysid/diagnosis/search/search.h"

namespace softgrip::sysid {

/// A structure with one more cause, which is confounded with one that it had.
struct Confounded {
  Cause cause;
  StructureFit fit;
  BlockLosses losses;  ///< held out
};

/// What is confounded with a cause of the structure and does not stand in it yet, fitted beside all of them.
[[nodiscard]] std::vector<Confounded> fit_confounded(const SearchData& data, const StructureFit& structure,
                                                     const Division& division);

}  // namespace softgrip::sysid
