#pragma once
// Detects a valve with stick-slip by tracking its jumps one by one.
//
// The command alone predicts a stick-slip motion for at most several tens of jumps (jump_tracking.h). Beyond
// that, a fit reproduces only the mean of all such motions, a play of the same band, and the steps remain in
// the residual. Therefore the steps are tested separately, with the valve positions that follow from the
// readings. The test checks two properties: the valve stays at rest while the command is within a constant
// band around it, and it moves to the command when the command leaves the band.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "sysid/diagnosis/search/fit.h"
#include "sysid/identification/identify.h"

namespace softgrip::sysid {

/// A detected stick-slip motion.
struct StickSlip {
  double band_kpa = 0;
  Interval band_ci95;
  std::size_t jumps = 0;        ///< number of jumps whose distance the readings resolve
  double scatter = 0;           ///< standard deviation of the distances, divided by their mean
  std::vector<Record> records;  ///< records with the valve position as drive
  StructureFit fit;             ///< the model behind the valve, fitted to these records
};

/// Smallest number of jump distances that determine a band.
inline constexpr std::size_t fewest_jumps = 20;
/// Largest scatter of the jump distances of a true band: in addition to the resolution of the readings, and
/// in total.
inline constexpr double most_scatter = 0.1, most_scatter_in_all = 0.13;
/// Scatter of jump distances that are uniformly distributed between the bounds of the tracker.
inline constexpr double scatter_of_chance = 0.19;

/// The width of a dead band and its 95 % interval [kPa].
struct Band {
  double value_kpa = 0;
  Interval ci95_kpa;
};

/// Returns the dead band of a valve from the sorted distances of at least fewest_jumps jumps. False jumps are
/// more often too short than too long, so the band is the mean of the middle half. The interval is that of a
/// trimmed mean, from the Winsorised variance (Tukey and McLaughlin, Sankhya A 25, 1963).
[[nodiscard]] Band band_of_jumps(std::span<const double> distances_kpa);

/// Searches for a stick-slip motion of the valve in front of a fitted structure. Returns an empty value if
/// there is none, or if the structure already has a dead band.
[[nodiscard]] std::optional<StickSlip> find_stick_slip(const std::vector<Record>& records,
                                                       const StructureFit& behind, double noise_mm,
                                                       unsigned threads);

/// Searches for the stick-slip motion again without one of the causes behind the valve, starting from the
/// current fit.
[[nodiscard]] std::optional<StickSlip> stick_slip_without(const std::vector<Record>& records,
                                                          const StickSlip& found, const Cause& cause,
                                                          double noise_mm, unsigned threads);

}  // namespace softgrip::sysid
