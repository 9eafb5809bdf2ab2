#pragma once
// Fits an invertible model to the readings of a log.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "model/model.h"
#include "sysid/logs/log.h"

namespace softgrip::studies {

struct MatchOptions {
  double most_ratio = 0.8;  ///< upper limit of the ratio beta/(alpha + 1/k0)
  std::size_t starts = 12;
  std::uint64_t seed = 1;
  unsigned threads = 0;
};

/// Fits a Bouc-Wen element in parallel with Kelvin-Voigt branches, behind a lag and a delay, by least squares
/// with the constraint beta <= most_ratio (alpha + 1/k0). The constraint is an additional residual, because
/// the constraint depends on several parameters. This residual is the weighted amount by which beta exceeds
/// its bound. The weight is so large that the amount remains below 1e-6 of the gain. `start` must contain
/// exactly these blocks: Bouc-Wen, Kelvin-Voigt, lag and delay. k0 keeps its value, because the data
/// determine only the sum alpha + 1/k0.
[[nodiscard]] model::Model invertible_match(const std::vector<sysid::Log>& logs, const model::Model& start,
                                            const MatchOptions& options);

}  // namespace softgrip::studies
