#pragma once
// Tracks the position of a sticking valve, sample by sample, from the readings.
//
// A valve with stick-slip starts each jump at the position where the previous jump ended, so small errors of
// the jump times accumulate. After several tens of jumps, the command alone no longer determines the position
// of the valve, but the readings do. A beam search follows several hypotheses about the positions of the
// valve in parallel. Each hypothesis simulates the part of the model behind the valve. At each sample, each
// hypothesis is continued with a jump and without a jump, as in Viterbi's algorithm. The search keeps the
// hypotheses that fit the readings best.

#include <cstddef>
#include <limits>
#include <vector>

#include "sysid/fitting/fit_space.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Distances between command and valve position at which a valve starts to move, as shares of the band. Below
/// breaks_loose_from, the valve stays at rest. Above breaks_loose_by, it always jumps. A jump sets the
/// valve position to the command at the time of the jump.
inline constexpr double breaks_loose_from = 0.7;
inline constexpr double breaks_loose_by = 1.4;

/// A hypothesis about the valve positions during one record.
struct ValvePath {
  std::vector<double> held_kpa;  ///< valve position at the end of each sample interval
  /// Distances between the command and the valve position at the jumps [kPa]. A jump is included only if the
  /// command changed slowly during the sample of the jump. The readings then resolve the time of the jump
  /// well.
  std::vector<double> distances_kpa;
  /// Sum of the squared differences between the readings and the simulated response to these valve positions.
  double sum_of_squares_mm2 = 0;
};

/// Returns the hypothesis that fits the readings best.
/// @param point  model behind the valve, without a dead band, with the initial state of each record.
/// @param index  index of the record.
/// @param band_kpa  dead band of the valve, > 0.
/// @param resolution_kpa  largest pressure difference that the readings cannot resolve, > 0.
/// @param worth_mm2  limit of the sum of squares. If all hypotheses exceed this limit, the search stops. The
/// result then has an infinite sum of squares and no positions.
[[nodiscard]] ValvePath track_jumps(const Record& record, std::size_t index, const FitPoint& point,
                                    double band_kpa, double resolution_kpa,
                                    double worth_mm2 = std::numeric_limits<double>::infinity());

/// Returns the record with the valve position as its drive.
[[nodiscard]] Record driven_by(const Record& record, const ValvePath& path);

}  // namespace softgrip::sysid
