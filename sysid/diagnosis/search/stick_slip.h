#pragma once
// Detects a valve with stick-slip by tracking its jumps one by one.
//
// The command alone predicts a stick-slip motion for at most several tens of jumps (jump_tracking.h). In a
// longer record, a fit reproduces only the mean of all possible stick-slip motions, which is a play of the
// same band. The jumps then remain in the residual. Therefore the jumps are tested separately, with valve
// positions that are determined from the readings. The test checks two properties: the valve stays at rest
// while the command is within a constant band around it, and it moves to the command when the command leaves
// the band.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "sysid/diagnosis/search/fit.h"
#include "sysid/identification/identify.h"

namespace softgrip::sysid {

/// A stick-slip motion that was detected.
struct StickSlip {
  double band_kpa = 0;
  Interval band_ci95;
  std::size_t jumps = 0;        ///< number of jumps whose distance the readings resolve
  double scatter = 0;           ///< standard deviation of the jump distances, divided by their mean
  std::vector<Record> records;  ///< records whose drive is the valve position
  StructureFit fit;             ///< model behind the valve, fitted to `records`
};

/// Two limits for the scatter of the jump distances of a real band. The first one applies to the scatter that
/// the resolution of the readings does not explain, and the second one to the total scatter.
inline constexpr double most_scatter = 0.1, most_scatter_in_all = 0.13;
/// Scatter of jump distances that are uniformly distributed between the limits of the tracker.
inline constexpr double scatter_of_chance = 0.19;

/// The width of a dead band and its 95 % interval [kPa].
struct Band {
  double value_kpa = 0;
  Interval ci95_kpa;
};

/// Returns the dead band of a valve from sorted jump distances. At least limits::fewest_events distances are
/// required. Wrongly detected jumps are more often too short than too long, so the band is the mean of the
/// middle half of the distances. The interval is that of a trimmed mean, from the Winsorised variance (Tukey
/// and McLaughlin, Sankhya A 25, 1963).
[[nodiscard]] Band band_of_jumps(std::span<const double> distances_kpa);

/// Searches for a stick-slip motion of the valve in front of a fitted structure. Returns nullopt if there is
/// no such motion, or if the structure contains a dead band.
[[nodiscard]] std::optional<StickSlip> find_stick_slip(const std::vector<Record>& records,
                                                       const StructureFit& behind, double noise_mm,
                                                       unsigned threads);

/// Repeats the search for the stick-slip motion after removal of one of the causes behind the valve. The
/// search starts at the current fit.
[[nodiscard]] std::optional<StickSlip> stick_slip_without(const std::vector<Record>& records,
                                                          const StickSlip& found, const Cause& cause,
                                                          double noise_mm, unsigned threads);

}  // namespace softgrip::sysid
