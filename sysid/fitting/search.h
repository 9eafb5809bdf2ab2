#pragma once
// Searching from many starts.

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "sysid/fitting/fit_space.h"
#include "sysid/fitting/separable_search.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// How far a search has come.
struct Progress {
  std::size_t done = 0;
  std::size_t starts = 0;
  double best_rmse_mm = 0;
  std::string stage;  ///< what is being done, where that is not a search from starts
};

/// Called from any thread, never from two at once. May be empty.
using ShowProgress = std::function<void(const Progress&)>;

/// Where the searches from all starts ended, in their order. A separable chain is searched by variable
/// projection: every start to its end on thinned records, and each place that one of them found, unless it is
/// far above the best, once more on all samples. Any other chain goes through the minimiser.
/// @param threads  0: as many as there are cores.
[[nodiscard]] std::vector<SearchResult> search(const FitSpace& space, const std::vector<Record>& records,
                                               const std::vector<FitPoint>& starts, unsigned threads,
                                               const ShowProgress& progress);

/// Puts the creep branches of a point into the order of the given time constants.
void order_branches(const std::vector<double>& like_s, FitPoint& point);

}  // namespace softgrip::sysid
