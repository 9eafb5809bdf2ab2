#pragma once
// Choosing causes where the valve sticks and jumps.

#include <cstddef>
#include <optional>

#include "sysid/diagnosis/search/search.h"
#include "sysid/diagnosis/search/selection.h"
#include "sysid/identification/identify.h"

namespace softgrip::sysid {

/// A staircase in numbers.
struct StaircaseEvidence {
  double band_kpa = 0;
  Interval band_ci95;
  std::size_t jumps = 0;       ///< that the band was estimated from
  double scatter = 0;          ///< of the distances of these jumps, standard deviation over mean
  double heldout_rmse_mm = 0;  ///< with the moments of the jumps taken from the readings
  Spread gain_percent;         ///< of that over the recalibrated model, held out
};

struct StaircaseSelection {
  /// The dead band first, then what was found behind it. `extended` and its losses are simulated from the
  /// command alone; what is `left`, and the causes' gains, with the moments of the jumps taken from the
  /// readings.
  Selection selection;
  StaircaseEvidence evidence;
};

/// Looks for a staircase in front of what was selected, then for one more cause behind it. Nothing where
/// there is no staircase, or where the model has a dead band already.
/// @param plain  what was selected without it.
/// @param options  of the search behind it.
[[nodiscard]] std::optional<StaircaseSelection> select_behind_staircase(const SearchData& data,
                                                                        const Selection& plain,
                                                                        double noise_mm,
                                                                        const Division& division,
                                                                        const SelectionOptions& options);

}  // namespace softgrip::sysid
