#pragma once
// Isolated wrong samples: found against their neighbours, hidden from every other fit.

#include <cstddef>
#include <vector>

#include "sysid/record.h"

namespace softgrip::sysid {

/// What was found. `share` of the readings lie `size_mm` (root mean square) beside their neighbours.
struct OutlierEvidence {
  std::size_t count = 0;
  std::size_t readings = 0;
  double share = 0;
  double size_mm = 0;
  double excess_mm = 0;  ///< what they add to the root mean square error of all readings
  double share_low = 0;  ///< 95 % interval of the share (Wilson)
  double share_high = 0;
  double size_low_mm = 0;  ///< 95 % interval of the size
  double size_high_mm = 0;
  bool present = false;  ///< more than noise would give, and worth a name
};

/// Finds readings that differ from both neighbours' line by more than noise can and hides them (NaN).
[[nodiscard]] OutlierEvidence hide_outliers(std::vector<Record>& records, double noise_mm);

}  // namespace softgrip::sysid
