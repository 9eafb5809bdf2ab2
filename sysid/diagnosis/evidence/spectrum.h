#pragma once
// The spectrum of a residual, and whether a line stands out of it.

#include <vector>

#include "sysid/diagnosis/evidence/evidence.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Periodograms with a Hann window, summed over the records, on about a hundred frequencies evenly spaced in
/// their logarithm. A line's power is compared with the median of its neighbourhood, so that the slow
/// structure of a misfit is no line.
/// @param structural_mm2  variance beyond the noise; 0: no shares.
[[nodiscard]] SpectrumEvidence spectrum_of(const std::vector<Record>& records,
                                           const std::vector<std::vector<double>>& residual_mm,
                                           double structural_mm2);

}  // namespace softgrip::sysid
