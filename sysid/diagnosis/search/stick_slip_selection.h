#pragma once
// Selects further causes if the valve shows stick-slip.

#include <cstddef>
#include <optional>

#include "sysid/diagnosis/search/search.h"
#include "sysid/diagnosis/search/selection.h"
#include "sysid/identification/identify.h"

namespace softgrip::sysid {

/// Parameters of a stick-slip motion and its error reduction.
struct StickSlipEvidence {
  double band_kpa = 0;
  Interval band_ci95;
  std::size_t jumps = 0;       ///< number of jumps from which the band was estimated
  double scatter = 0;          ///< standard deviation of the jump distances, divided by their mean
  double heldout_rmse_mm = 0;  ///< held-out RMSE with the jump times from the readings
  Spread gain_percent;         ///< held-out error reduction relative to the refitted model
};

struct StickSlipSelection {
  /// The selection contains the dead band first, then the causes behind the valve. `extended` and its losses
  /// are simulated from the command alone. `left` and the error reductions use the jump times from the
  /// readings.
  Selection selection;
  StickSlipEvidence evidence;
};

/// Searches for stick-slip of the valve in front of the selected structure, then for one more cause behind
/// the valve. Returns an empty value if there is no stick-slip, or if the model already has a dead band.
/// @param plain  selection without stick-slip.
/// @param options  options of the search for causes behind the valve.
[[nodiscard]] std::optional<StickSlipSelection> select_behind_stick_slip(const SearchData& data,
                                                                         const Selection& plain,
                                                                         double noise_mm,
                                                                         const Division& division,
                                                                         const SelectionOptions& options);

}  // namespace softgrip::sysid
