#pragma once
// Detects a valve with stick-slip by prediction of one jump at a time.
//
// The command alone predicts a stick-slip motion for at most several tens of jumps (jump_tracking.h). A fit
// then reproduces only the mean of all such motions, a play of the same band, and the steps remain in the
// residual. Therefore the steps are tested separately, from the valve positions that the readings show. The
// test asks two questions. Does the valve stay while the command is within one constant band? Does it move to
// the command when the command leaves the band?

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
  std::size_t jumps = 0;        ///< whose distance the readings resolve
  double scatter = 0;           ///< standard deviation of the distances over their mean
  std::vector<Record> records;  ///< driven by the valve position
  StructureFit fit;             ///< the chain behind the valve, fitted to these records
};

/// Smallest number of jump distances that determine a band.
inline constexpr std::size_t fewest_jumps = 20;
/// Largest scatter of a band's distances: beyond the resolution of the readings, and in total.
inline constexpr double most_scatter = 0.1, most_scatter_in_all = 0.13;
/// Scatter of distances that are uniform between the tracker's bounds.
inline constexpr double scatter_of_chance = 0.19;

/// A band and its 95 % interval [kPa].
struct Band {
  double value_kpa = 0;
  Interval ci95_kpa;
};

/// Returns the band of a valve that jumped over `distances_kpa`, sorted, with at least fewest_jumps elements.
/// False jumps are more often too short than too long. Therefore the band is the mean of the middle half. The
/// interval is that of a trimmed mean, from the Winsorised variance (Tukey and McLaughlin, Sankhya A 25,
/// 1963).
[[nodiscard]] Band band_of_jumps(std::span<const double> distances_kpa);

/// Searches for a stick-slip motion in front of a fitted structure. Returns an empty value if there is none,
/// or if the structure already has a dead band.
[[nodiscard]] std::optional<StickSlip> find_stick_slip(const std::vector<Record>& records,
                                                       const StructureFit& behind, double noise_mm,
                                                       unsigned threads);

/// Searches again without one of the causes behind the valve, from the current fit.
[[nodiscard]] std::optional<StickSlip> stick_slip_without(const std::vector<Record>& records,
                                                          const StickSlip& found, const Cause& cause,
                                                          double noise_mm, unsigned threads);

}  // namespace softgrip::sysid
