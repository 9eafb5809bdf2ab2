#pragma once
// Tracks the position of a sticking valve, sample by sample, from the readings.
//
// A valve with stick-slip starts each jump at the end of the last one, so small errors of the jump times
// accumulate. After several tens of jumps, the command alone no longer determines the position of the valve.
// The readings determine it. A beam search follows several path hypotheses of the valve in parallel, each
// with its own chain behind the valve. It decides at each sample between jump and no jump, as in Viterbi's
// algorithm, and keeps the hypotheses that fit the readings best.

#include <cstddef>
#include <limits>
#include <vector>

#include "sysid/fitting/fit_space.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Shares of the band between which a valve breaks loose. The valve never jumps below the first share and
/// always jumps at the second. A smaller command difference leaves the valve at rest. After a jump, the valve
/// is at the command.
inline constexpr double breaks_loose_from = 0.7;
inline constexpr double breaks_loose_by = 1.4;

/// A path hypothesis of the valve through one record.
struct ValvePath {
  std::vector<double> held_kpa;  ///< at the end of every sample's step
  /// Distances between the command and the valve position at the jumps [kPa]. Only jumps are listed whose
  /// time the readings resolve well: the command moved little during their sample.
  std::vector<double> distances_kpa;
  double sum_of_squares_mm2 = 0;  ///< reading minus the response of the chain behind the valve
};

/// Returns the path that fits the readings best.
/// @param point  the chain behind the valve and its initial state in every record; without its own dead band.
/// @param index  of the record.
/// @param band_kpa  > 0.
/// @param resolution_kpa  > 0: pressure differences that the readings cannot resolve.
/// @param worth_mm2  the search stops for a path that exceeds this sum of squares. It then returns only an
/// infinite sum of squares.
[[nodiscard]] ValvePath track_jumps(const Record& record, std::size_t index, const FitPoint& point,
                                    double band_kpa, double resolution_kpa,
                                    double worth_mm2 = std::numeric_limits<double>::infinity());

/// Returns the record with the valve position as its drive.
[[nodiscard]] Record driven_by(const Record& record, const ValvePath& path);

}  // namespace softgrip::sysid
