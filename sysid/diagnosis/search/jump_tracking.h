#pragma once
// Tracks the position of a sticking valve, sample by sample, from the readings.
//
// A valve with stick-slip starts each jump at the end of the previous one, so small errors of the jump times
// accumulate. After several tens of jumps, the command alone no longer determines the position of the valve,
// but the readings do. A beam search follows several hypotheses of the valve's path in parallel. Each
// hypothesis simulates the part of the model behind the valve. At each sample, the search considers a jump
// and no jump, as in Viterbi's algorithm, and keeps the hypotheses that fit the readings best.

#include <cstddef>
#include <limits>
#include <vector>

#include "sysid/fitting/fit_space.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Range of command differences at which a valve breaks loose, as shares of the band. The valve stays at rest
/// below the first share and always jumps at the second. After a jump, the valve position equals the command.
inline constexpr double breaks_loose_from = 0.7;
inline constexpr double breaks_loose_by = 1.4;

/// A path hypothesis of the valve through one record.
struct ValvePath {
  std::vector<double> held_kpa;  ///< valve position at the end of every sample's step
  /// Distances between the command and the valve position at the jumps [kPa]. A jump is listed if the command
  /// moved little during its sample, so that the readings resolve its time well.
  std::vector<double> distances_kpa;
  double sum_of_squares_mm2 = 0;  ///< sum of squared differences between the readings and the response of the
                                  ///< model behind the valve
};

/// Returns the path that fits the readings best.
/// @param point  the model behind the valve, without a dead band, and its initial state in every record.
/// @param index  index of the record.
/// @param band_kpa  dead band of the valve, > 0.
/// @param resolution_kpa  pressure difference that the readings cannot resolve, > 0.
/// @param worth_mm2  limit at which the search stops, because every path has a larger sum of squares. The
/// result then contains an infinite sum of squares and no path.
[[nodiscard]] ValvePath track_jumps(const Record& record, std::size_t index, const FitPoint& point,
                                    double band_kpa, double resolution_kpa,
                                    double worth_mm2 = std::numeric_limits<double>::infinity());

/// Returns the record with the valve position as its drive.
[[nodiscard]] Record driven_by(const Record& record, const ValvePath& path);

}  // namespace softgrip::sysid
