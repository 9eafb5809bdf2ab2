#pragma once
// Detects stick-slip of a valve by tracking each jump of the valve.
//
// From the command alone, a stick-slip motion can be predicted for at most several tens of jumps
// (jump_tracking.h). In a longer record, a fit can reproduce only the mean of all possible stick-slip
// motions, which is a play with the same band. The jumps then remain in the residual. Therefore the jumps are
// tested separately. The valve positions for this test are determined from the readings. The test checks two
// properties of the valve. First, the valve stays at rest while the command is within a constant band.
// Second, the valve moves to the command when the command leaves the band. If the valve has a stick-slip
// motion, further causes are selected.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "sysid/diagnosis/search/fit.h"
#include "sysid/diagnosis/search/search.h"
#include "sysid/diagnosis/search/selection.h"
#include "sysid/identification/identify.h"

namespace softgrip::sysid {

/// Width of a dead band with its 95 % interval [kPa].
struct Band {
  double band_kpa = 0;
  Interval band_ci95;
};

/// Dead band of a valve and the jumps from whose distances it was estimated.
struct JumpingBand : Band {
  std::size_t jumps = 0;  ///< number of jumps whose jump distance the readings resolve
  double scatter = 0;     ///< standard deviation of the jump distances, divided by their mean
};

/// A stick-slip motion that was detected.
struct StickSlip : JumpingBand {
  std::vector<Record> records;  ///< records with the valve position as drive
  StructureFit fit;             ///< model behind the valve, fitted to `records`
};

/// Limits for the scatter of the jump distances of a real band. `most_scatter` applies to the part of the
/// scatter that the resolution of the readings does not explain. `most_scatter_in_all` applies to the total
/// scatter.
inline constexpr double most_scatter = 0.1, most_scatter_in_all = 0.13;
/// Scatter of random jump distances, which are uniformly distributed between the limits of the tracker.
inline constexpr double scatter_of_chance = 0.19;

/// Returns the dead band of a valve from sorted jump distances. At least limits::fewest_events distances are
/// required. If a jump is detected wrongly, its distance is usually too short. Therefore the band is the mean
/// of the middle half of the distances. The interval of this trimmed mean is computed from the Winsorised
/// variance (Tukey and McLaughlin, Sankhya A 25, 1963).
[[nodiscard]] Band band_of_jumps(std::span<const double> distances_kpa);

/// Searches for a stick-slip motion of the valve. Returns nullopt if there is no stick-slip motion.
/// @param behind  fitted structure of the finger behind the valve, without a dead band.
[[nodiscard]] std::optional<StickSlip> find_stick_slip(const std::vector<Record>& records,
                                                       const StructureFit& behind, double noise_mm,
                                                       unsigned threads);

/// Removes one of the causes behind the valve and searches for the stick-slip motion a second time. This
/// search starts at the result `found`.
[[nodiscard]] std::optional<StickSlip> stick_slip_without(const std::vector<Record>& records,
                                                          const StickSlip& found, const Cause& cause,
                                                          double noise_mm, unsigned threads);

/// Parameters of a stick-slip motion, and the error reduction by this motion.
struct StickSlipEvidence : JumpingBand {
  double heldout_rmse_mm = 0;  ///< held-out RMSE if the times of the jumps are determined from the readings
  /// Held-out error reduction by the stick-slip motion and the causes behind the valve, compared with the
  /// refitted model.
  Spread gain_percent;
};

struct StickSlipSelection {
  /// Selection with the dead band as the first cause, followed by the causes behind the valve. For `extended`
  /// and its losses, the model is simulated from the command alone. For `left` and the error reductions, the
  /// times of the jumps are determined from the readings.
  Selection selection;
  StickSlipEvidence evidence;
};

/// Searches for stick-slip of the valve in front of the selected structure, and then for causes behind the
/// valve. Returns nullopt if there is no stick-slip, or if the given model already contains a dead band.
/// @param plain  selection without stick-slip.
/// @param options  options of the search for causes behind the valve.
[[nodiscard]] std::optional<StickSlipSelection> select_behind_stick_slip(const SearchData& data,
                                                                         const Selection& plain,
                                                                         double noise_mm,
                                                                         const Division& division,
                                                                         const SelectionOptions& options);

}  // namespace softgrip::sysid
