#pragma once
// Selects further causes if the valve has a stick-slip motion.

#include <cstddef>
#include <optional>

#include "sysid/diagnosis/search/search.h"
#include "sysid/diagnosis/search/selection.h"
#include "sysid/identification/identify.h"

namespace softgrip::sysid {

/// Parameters of a stick-slip motion, and the error reduction by this motion.
struct StickSlipEvidence {
  double band_kpa = 0;
  Interval band_ci95;
  std::size_t jumps = 0;       ///< number of jumps from whose distances the band was estimated
  double scatter = 0;          ///< standard deviation of the jump distances, divided by their mean
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
