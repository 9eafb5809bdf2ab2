#pragma once
// Where a search for a steady oscillation begins.

#include <cstddef>
#include <vector>

#include "sysid/record.h"

namespace softgrip::sysid {

/// Frequencies at which the residual's spectrum over the whole campaign stands out against its neighbourhood,
/// the clearest first [Hz]. What is slower than a tenth of the campaign's reach, or than 0.2 Hz, is a
/// wandering zero and no oscillation.
/// @param residual_mm  by record, as long as the record; NaN where there is no reading.
[[nodiscard]] std::vector<double> spectrum_peaks_hz(const std::vector<Record>& records,
                                                    const std::vector<std::vector<double>>& residual_mm,
                                                    std::size_t count);

}  // namespace softgrip::sysid
