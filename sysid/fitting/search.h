#pragma once
// Parameter search from many starting points.

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "sysid/fitting/fit_space.h"
#include "sysid/fitting/separable_search.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Progress of a search.
struct Progress {
  std::size_t done = 0;
  std::size_t starts = 0;
  double best_rmse_mm = 0;
  std::string stage;  ///< name of the current task, if it is not a search from starting points
};

/// Callback for progress. It is called from any thread, but never concurrently. It may be empty.
using ShowProgress = std::function<void(const Progress&)>;

/// Searches from all starting points and returns the results in their order. A separable chain is fitted by
/// variable projection: first from each starting point on thinned records. Each distinct minimum with an RMSE
/// of at most 1.3 times the lowest is then refined on all samples. Any other chain is fitted by minimise().
/// @param threads  0: one thread for each core.
[[nodiscard]] std::vector<SearchResult> search(const FitSpace& space, const std::vector<Record>& records,
                                               const std::vector<FitPoint>& starts, unsigned threads,
                                               const ShowProgress& progress);

/// Sorts the creep branches of a point into the order of the given time constants.
void order_branches(const std::vector<double>& like_s, FitPoint& point);

}  // namespace softgrip::sysid
