#pragma once
// A valve that sticks and jumps, judged one jump ahead.
//
// From the command alone a staircase can be foretold for some tens of jumps at most (jump_tracking.h); what a
// fit then gains is the mean of all staircases, a play of the same band, and the steps themselves are left in
// the residual. So the steps are looked for on their own: given where the readings show the valve to stand,
// does it stay while the command is within one and the same band, and go to the command when it is beyond?

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "sysid/diagnosis/search/fit.h"
#include "sysid/identification/identify.h"

namespace softgrip::sysid {

/// A staircase that was found.
struct Staircase {
  double band_kpa = 0;
  Interval band_ci95;
  std::size_t jumps = 0;        ///< whose distance the readings resolve
  double scatter = 0;           ///< of the distances, standard deviation over mean
  std::vector<Record> records;  ///< driven by where the valve stood
  StructureFit fit;             ///< what stands behind the valve, fitted to these
};

/// What makes distances a band: fewer are none.
inline constexpr std::size_t fewest_jumps = 20;
/// The scatter of a band's distances beyond what the readings resolve of it, and in all.
inline constexpr double most_scatter = 0.1, most_scatter_in_all = 0.13;
/// Where anything is possible between the tracker's bounds.
inline constexpr double scatter_of_chance = 0.19;

/// A band and its 95 % interval [kPa].
struct Band {
  double value_kpa = 0;
  Interval ci95_kpa;
};

/// The band of a valve that jumped over `distances_kpa`, sorted, at least fewest_jumps of them. Jumps that
/// were taken for wrong ones are more often too short than too long, so that it is the mean of the middle
/// half; the interval is that of a trimmed mean, by the Winsorised variance (Tukey and McLaughlin, Sankhya A
/// 25, 1963).
[[nodiscard]] Band band_of_jumps(std::span<const double> distances_kpa);

/// Looks for a staircase in front of a fitted structure. Nothing where there is none, or where the structure
/// has a dead band already.
[[nodiscard]] std::optional<Staircase> find_staircase(const std::vector<Record>& records,
                                                      const StructureFit& behind, double noise_mm,
                                                      unsigned threads);

/// The same without one of the causes that stand behind it, from where it stands.
[[nodiscard]] std::optional<Staircase> staircase_without(const std::vector<Record>& records,
                                                         const Staircase& found, const Cause& cause,
                                                         double noise_mm, unsigned threads);

}  // namespace softgrip::sysid
