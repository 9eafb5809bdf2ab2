#pragma once
// An invertible model that answers as some log does.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "model/model.h"
#include "sysid/logs/log.h"

namespace softgrip::tools {

struct MatchOptions {
  double most_ratio = 0.8;  ///< of beta/(alpha + 1/k0)
  std::size_t starts = 12;
  std::uint64_t seed = 1;
  unsigned threads = 0;
};

/// Least squares of a Bouc-Wen element beside Kelvin-Voigt branches behind a lag and a delay, with
/// beta <= most_ratio (alpha + 1/k0). The bound is on a combination, so it is put into the residuals: one
/// more row of most_ratio's excess, heavy enough that what is left of it is below 1e-6 of the gain.
/// `start` has exactly those blocks; k0 keeps its value, since only alpha + 1/k0 is visible.
[[nodiscard]] model::Model invertible_match(const std::vector<sysid::Log>& logs, const model::Model& start,
                                            const MatchOptions& options);

}  // namespace softgrip::tools
