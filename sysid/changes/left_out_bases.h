#pragma once
// Later readings relative to baseline models that were fitted without one unit of the healthy logs. Their
// differences show the uncertainty of the baseline model.

#include <vector>

#include "sysid/changes/base.h"
#include "sysid/changes/later_readings.h"

namespace softgrip::sysid {

/// Returns copies of the baseline. The model of copy i was fitted to all cross-validation units except unit
/// i.
[[nodiscard]] std::vector<Base> left_out_bases(const Base& base);

/// Returns the later readings relative to each of these baselines.
/// @param bases  result of left_out_bases().
/// @param later  later records at the full sampling rate.
/// @param left  residuals for the baseline model that was fitted to all units. NaN: the reading is not
/// evaluated.
[[nodiscard]] std::vector<LaterReadings> left_out_readings(const std::vector<Base>& bases,
                                                           const std::vector<Record>& later,
                                                           const std::vector<std::vector<double>>& left);

}  // namespace softgrip::sysid
