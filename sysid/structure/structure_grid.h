#pragma once
// Defines the parameters of the operators that are fixed before a fit, and chooses them for records.

#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Parameters of the operators that are fixed before a fit: thresholds, time constants, and threshold
/// pressures of creep (hinges).
struct StructureGrid {
  double time_unit_s = 1;  ///< result of time_unit_s() for the records
  double largest_kpa = 0;  ///< largest magnitude of the drive
  double span_mm = 0;      ///< largest magnitude of the readings
  /// Thresholds of the play operators in increasing order. The elastic operator (threshold 0) is not in the
  /// list.
  std::vector<double> thresholds_kpa;
  std::vector<double> ladder_s;  ///< time constants of the creep branches, in increasing order
  /// Smallest time constant that counts as slow creep.
  double slow_from_s = 0;
  std::vector<double> hinges_kpa;  ///< threshold pressures of pressure-dependent creep, in increasing order
  std::vector<double> hinge_ladder_s;  ///< time constants of the creep branches above each threshold pressure
                                       ///< (hinge)
  double shortest_period_s = 0;        ///< shortest period of a linear mode
};

/// Returns the thresholds, time constants and hinges that are used for these records. If the records contain
/// at most two cycles, the number of play operators is smaller.
[[nodiscard]] StructureGrid grid_for(const std::vector<Record>& records);

/// Returns the smallest instantaneous elastic gain of a structure that has an inverse [mm/kPa].
[[nodiscard]] double least_elastic_mm_per_kpa(const StructureGrid& grid);
/// Returns the longest period of a linear mode in a fit [s].
[[nodiscard]] double longest_mode_s(const StructureGrid& grid);

}  // namespace softgrip::sysid
