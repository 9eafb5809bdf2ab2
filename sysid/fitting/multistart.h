#pragma once
// Draws start points for a fit, and searches for the parameters of a model from all of them.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "model/model.h"
#include "sysid/fitting/fit_space.h"
#include "sysid/fitting/separable_search.h"
#include "sysid/logs/log.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Progress of a search, for display.
struct Progress {
  std::size_t done = 0;
  std::size_t starts = 0;
  double best_rmse_mm = 0;
  std::string stage;  ///< name of the current task; empty: the search from many start points
};

/// Callback that receives the progress; may be empty. Any thread may call the callback, but never two threads
/// at the same time.
using ShowProgress = std::function<void(const Progress&)>;

/// Searches from all start points and returns the results in the order of the start points. A separable chain
/// is fitted by variable projection. With several start points and at least 8000 samples, the first fits use
/// thinned records. Each distinct minimum whose RMSE is at most 1.3 times the lowest RMSE is then refined on
/// all samples. Any other chain is fitted by minimise(). `threads` is the number of threads; 0: one for each
/// core.
[[nodiscard]] std::vector<SearchResult> search(const FitSpace& space, const std::vector<Record>& records,
                                               const std::vector<FitPoint>& starts, unsigned threads,
                                               const ShowProgress& progress);

/// Sorts the creep branches of a point by their time constants. The order (rising or falling) is that of the
/// time constants in `like_s`.
void order_branches(const std::vector<double>& like_s, FitPoint& point);

/// Returns `count` start points. The first one is the given model. The others are random points, alternately
/// at the scale of the data (pressure, span, length) and around the given model. Parameters that are not free
/// in `space` keep their values.
[[nodiscard]] std::vector<FitPoint> draw_starts(const FitSpace& space, const FitPoint& given,
                                                const std::vector<Record>& records, std::size_t count,
                                                std::uint64_t seed);

/// Returns the default structure: a Bouc-Wen block, and a Kelvin-Voigt block with `branches` branches. Its
/// parameter values are scaled to the data.
[[nodiscard]] model::Model base_model(const std::vector<Log>& logs, std::size_t branches);
[[nodiscard]] model::Model base_model(const std::vector<Record>& records, std::size_t branches);

}  // namespace softgrip::sysid
